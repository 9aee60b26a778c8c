#include "tools/commands/command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>

namespace ossa::commands {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void NoteInterrupt(int) { interrupted = 1; }

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void Parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    throw HelpShown{};
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} (see 'ossa {} --help')", error.what(), argv[0]));
  }
}

bool Interrupted() { return interrupted != 0; }

void InstallInterruptHandler() {
  std::signal(SIGINT, NoteInterrupt);
  std::signal(SIGTERM, NoteInterrupt);
}

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (open_line_) fmt::print(stderr, "\n");
}

void Progress::Update(double done, double total, const std::string& note) {
  const double now_s = Now_s();
  const bool last = total > 0 && done >= total;
  const double interval_s = terminal_ ? 0.1 : 5.0;
  if (quiet_ || (now_s - last_s_ < interval_s && !last)) return;
  last_s_ = now_s;
  const double share = total > 0 ? done / total : 0.0;
  if (terminal_) {
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(share * kWidth);
    fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} % {}\033[K", label_, "", filled, "",
               kWidth - filled, 100 * share, note);
    std::fflush(stderr);
    open_line_ = true;
  } else {
    fmt::print(stderr, "{}: {:.0f} of {:.0f} {}\n", label_, done, total, note);
  }
}

}  // namespace ossa::commands
