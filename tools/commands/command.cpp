#include "tools/commands/command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>

#include "tools/commands/process.h"

namespace ossa::commands {
namespace {

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <typename T>
bool IsWhole(const std::string& text) {
  T number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

// CLI11 makes -1 the largest unsigned number, cuts whole numbers that are too large down to the
// largest, takes nan and inf, which pass by every range, and an empty word (a shell's unset
// variable) as a file's name.
void CheckValues(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    for (const std::string& text : option->results()) {
      if (text.empty() && option->get_expected_min() > 0) {
        throw UsageError(fmt::format("{}: expected a value, found ''", option->get_name()));
      }
      const bool good = type.starts_with("UINT")  ? IsWhole<uint64_t>(text)
                        : type.starts_with("INT") ? IsWhole<int64_t>(text)
                        : type.starts_with("FLOAT")
                            ? std::isfinite(std::strtod(text.c_str(), nullptr))
                            : true;
      if (good) continue;
      const char* expected = type.starts_with("UINT")  ? "a whole number from 0 up"
                             : type.starts_with("INT") ? "a whole number"
                                                       : "a finite number";
      throw UsageError(
          fmt::format("{}: expected {}, found '{}'", option->get_name(), expected, text));
    }
  }
}

}  // namespace

void Parse(CLI::App& app, int argc, char** argv) {
  app.name(fmt::format("ossa {}", argv[0]));
  try {
    app.parse(argc, argv);
    CheckValues(app);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    throw HelpShown{};
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} (see 'ossa {} --help')", error.what(), argv[0]));
  }
}

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (open_line_) Say("\n");
}

void Progress::Update(double done, double total, const std::string& note) {
  const double now_s = Now_s();
  const bool last = total > 0 && done >= total;
  const double interval_s = terminal_ ? 0.1 : 5.0;
  if (quiet_ || (now_s - last_s_ < interval_s && !last)) return;
  last_s_ = now_s;
  const double share = total > 0 ? done / total : 0.0;
  if (terminal_) {
    constexpr int kWidth = 30;  // characters, by eye
    const int filled = static_cast<int>(share * kWidth);
    Say(fmt::format("\r{} [{:#<{}}{:.<{}}] {:3.0f} % {}\033[K", label_, "", filled, "",
                    kWidth - filled, 100 * share, note));
    open_line_ = true;
  } else {
    Say(fmt::format("{}: {:.0f} of {:.0f} {}\n", label_, done, total, note));
  }
}

}  // namespace ossa::commands
