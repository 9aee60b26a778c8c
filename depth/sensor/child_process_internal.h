#pragma once
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::depth {

/// A helper program whose standard output is read through a pipe; its standard error is discarded.
/// Killed by the destructor.
class ChildProcess {
 public:
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class Outcome { kRead, kTimeout, kClosed };
  /// Waits for output: kRead if there is some, kClosed at its end.
  Outcome WaitForOutput(std::chrono::milliseconds timeout) const;
  /// Reads exactly `size` bytes; kTimeout if no byte arrives for `patience`, kClosed at the end of
  /// the output.
  Outcome ReadExactly(void* to, size_t size, std::chrono::milliseconds patience) const;
  /// Waits for a child whose output is closed, and returns how it ended: "signal 11" or "status 1".
  std::string Ending();

 private:
  pid_t pid_ = -1;
  int fd_ = -1;
};

}  // namespace ossa::depth
