#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "depth/base/error.h"
#include "depth/sensor/child_process_internal.h"

extern char** environ;

namespace ossa::depth {

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw InputError(program.string() + ": no pipe to it: " + std::strerror(errno));
  }
  constexpr int kPipeSize = 1 << 20;  // bytes; by hand: more than a frame, to decode ahead
  fcntl(ends[1], F_SETPIPE_SZ, kPipeSize);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // In its own process group: Ctrl-C must reach only this process, which ends the child.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string name = program.string();
  std::vector<char*> argv = {name.data()};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const int error = posix_spawn(&pid_, name.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error != 0) {
    close(ends[0]);
    throw InputError(name + ": cannot be started: " + std::strerror(error));
  }
  fd_ = ends[0];
}

ChildProcess::~ChildProcess() {
  close(fd_);
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

ChildProcess::Outcome ChildProcess::WaitForOutput(std::chrono::milliseconds timeout) const {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    pollfd fd{fd_, POLLIN, 0};
    const int ready = poll(&fd, 1, static_cast<int>(std::max<int64_t>(left.count(), 0)));
    if (ready > 0) return (fd.revents & POLLIN) != 0 ? Outcome::kRead : Outcome::kClosed;
    if (ready == 0 || errno != EINTR) return Outcome::kTimeout;
  }
}

ChildProcess::Outcome ChildProcess::ReadExactly(void* to, size_t size,
                                                std::chrono::milliseconds patience) const {
  char* at = static_cast<char*>(to);
  while (size > 0) {
    const Outcome outcome = WaitForOutput(patience);
    if (outcome != Outcome::kRead) return outcome;
    const ssize_t got = read(fd_, at, size);
    if (got == 0) return Outcome::kClosed;
    if (got < 0) {
      if (errno == EINTR) continue;
      return Outcome::kClosed;
    }
    at += got;
    size -= static_cast<size_t>(got);
  }
  return Outcome::kRead;
}

std::string ChildProcess::Ending() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                             : "status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace ossa::depth
