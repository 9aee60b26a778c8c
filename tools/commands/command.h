#pragma once
#include <functional>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace ossa::commands {

/// One subcommand of `ossa`: argv[0] is its name. Returns the exit status; throws UsageError for
/// wrong usage and InputError (or any std::exception) for failure: main turns them into one line.
using CommandFunction = int (*)(int argc, char** argv);

struct Command {
  std::string_view name;
  std::string_view summary;
  CommandFunction run;
};

/// Wrong usage: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Options that exclude each other, or one that needs another.
struct Contradiction : UsageError {
  using UsageError::UsageError;
};

/// Thrown after --help was printed: exit status 0.
struct HelpShown {};

/// Parses the arguments of a subcommand; missing options are taken from the user's file of
/// defaults, but those named in `left_out`. Throws UsageError, HelpShown (also after `--describe`,
/// see describe.h), or InputError for that file. ParseConsistently() is for options that depend on
/// each other.
void Parse(CLI::App& app, int argc, char** argv, const std::set<std::string>& left_out = {});

/// Whether Ctrl-C or SIGTERM was received. Long loops check it, stop, and leave no half-written
/// file.
bool Interrupted();

/// Progress on stderr with the time left: one line rewritten in place on a terminal, a plain line
/// about every five seconds otherwise, nothing when quiet.
class Progress {
 public:
  Progress(std::string label, bool quiet);
  ~Progress();
  void Update(double done, double total, const std::string& note = {});

 private:
  std::string label_;
  bool quiet_;
  bool terminal_;
  bool open_line_ = false;
  double start_s_;
  double last_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace ossa::commands
