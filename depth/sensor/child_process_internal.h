#pragma once
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::depth {

/// A helper program whose standard output is read through a pipe; its standard error goes nowhere.
/// Killed when destroyed.
class ChildProcess {
 public:
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class Outcome { kRead, kTimeout, kClosed };
  /// Waits until output is there: kRead if so, kClosed if it ended.
  Outcome WaitForOutput(std::chrono::milliseconds timeout) const;
  /// Exactly `size` bytes; kTimeout when no byte came for so long, kClosed when the output ended.
  Outcome ReadExactly(void* to, size_t size, std::chrono::milliseconds patience) const;
  /// Waits for the end of a child whose output is closed, and says how it ended: "signal 11" or
  /// "status 1".
  std::string Ending();

 private:
  pid_t pid_ = -1;
  int fd_ = -1;
};

}  // namespace ossa::depth
