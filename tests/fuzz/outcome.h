#pragma once
#include <cstdlib>
#include <string>

#include "depth/base/error.h"

namespace ossa::fuzz {

/// Runs a parser: it must return, or throw an InputError of one line; all else is a finding.
template <typename Parse>
void ExpectValueOrOneLine(const Parse& parse) {
  try {
    parse();
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) abort();
  }
}

}  // namespace ossa::fuzz
