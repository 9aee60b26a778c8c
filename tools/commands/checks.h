#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

namespace ossa::commands {

/// Replaces CLI::PositiveNumber, whose message contains the largest double.
inline CLI::Validator Positive() {
  const auto complaint = [](const std::string& text) {
    const bool good = std::strtod(text.c_str(), nullptr) > 0;
    return good ? std::string() : fmt::format("expected a number above 0, found '{}'", text);
  };
  return CLI::Validator(complaint, "POSITIVE");
}

inline CLI::Validator NotNegative() {
  const auto complaint = [](const std::string& text) {
    const bool good = std::strtod(text.c_str(), nullptr) >= 0;
    return good ? std::string() : fmt::format("expected a number from 0 up, found '{}'", text);
  };
  return CLI::Validator(complaint, "NONNEGATIVE");
}

}  // namespace ossa::commands
