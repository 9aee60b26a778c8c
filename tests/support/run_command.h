#pragma once
#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace ossa::test {

/// The result of a command.
struct CommandResult {
  int exit_status = -1;  // 128 + signal if a signal ended it, as a shell says
  std::string out;
  std::string err;
  bool timed_out = false;  // it was killed after the time allowed
};

/// A program under way, both its outputs being collected. Killed when destroyed before Wait.
class RunningCommand {
 public:
  /// argv[0] is the program's path. Throws std::runtime_error when it cannot be started.
  explicit RunningCommand(const std::vector<std::string>& argv);
  ~RunningCommand();
  RunningCommand(const RunningCommand&) = delete;
  RunningCommand& operator=(const RunningCommand&) = delete;

  void Signal(int signal) const;
  /// Waits for its end, at most so long.
  CommandResult Wait(std::chrono::milliseconds timeout);
  /// Reads its stderr until `text` has come; false after `timeout`.
  bool WaitForError(const std::string& text, std::chrono::milliseconds timeout);

 private:
  // Takes what the pipes hold, waiting at most until the deadline; false at the end of both.
  bool Collect(std::chrono::steady_clock::time_point deadline);

  pid_t pid_ = -1;
  int out_fd_ = -1;
  int err_fd_ = -1;
  CommandResult result_;
};

inline constexpr std::chrono::milliseconds kCommandTimeout{120000};

/// The `ossa` of this build with these arguments.
std::string OssaPath();
RunningCommand StartOssa(const std::vector<std::string>& arguments);
CommandResult RunOssa(const std::vector<std::string>& arguments,
                      std::chrono::milliseconds timeout = kCommandTimeout);
CommandResult RunProgram(const std::vector<std::string>& argv,
                         std::chrono::milliseconds timeout = kCommandTimeout);

/// Number of lines in a text: what a command says on failure must be exactly one.
int LineCount(const std::string& text);

}  // namespace ossa::test
