#include "tests/support/run_command.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "tests/support/places.h"

namespace ossa::test {
namespace {

using Clock = std::chrono::steady_clock;

std::array<int, 2> Pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
  }
  return ends;
}

[[noreturn]] void BecomeProgram(std::vector<char*> argv, int out, int err) {
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execv(argv[0], argv.data());
  _exit(127);
}

// Appends what is there; false at the end of the pipe, which is then closed.
bool TakeFrom(int* fd, std::string* text) {
  std::array<char, 65536> buffer{};
  const ssize_t got = read(*fd, buffer.data(), buffer.size());
  if (got > 0) {
    text->append(buffer.data(), static_cast<size_t>(got));
    return true;
  }
  close(*fd);
  *fd = -1;
  return false;
}

int MillisecondsUntil(Clock::time_point deadline) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::max<int64_t>(left, 0));
}

}  // namespace

RunningCommand::RunningCommand(const std::vector<std::string>& argv) {
  if (access(argv.at(0).c_str(), X_OK) != 0) throw std::runtime_error("no program " + argv[0]);
  std::vector<char*> words;
  for (const std::string& word : argv) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const auto out = Pipe();
  const auto err = Pipe();
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (pid_ == 0) BecomeProgram(words, out[1], err[1]);
  close(out[1]);
  close(err[1]);
  out_fd_ = out[0];
  err_fd_ = err[0];
}

RunningCommand::~RunningCommand() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (out_fd_ >= 0) close(out_fd_);
  if (err_fd_ >= 0) close(err_fd_);
}

void RunningCommand::Signal(int signal) const { kill(pid_, signal); }

bool RunningCommand::Collect(Clock::time_point deadline) {
  std::array<pollfd, 2> fds = {pollfd{out_fd_, POLLIN, 0}, pollfd{err_fd_, POLLIN, 0}};
  if (poll(fds.data(), fds.size(), MillisecondsUntil(deadline)) > 0) {
    if (fds[0].revents != 0) TakeFrom(&out_fd_, &result_.out);
    if (fds[1].revents != 0) TakeFrom(&err_fd_, &result_.err);
  }
  return out_fd_ >= 0 || err_fd_ >= 0;
}

bool RunningCommand::WaitForError(const std::string& text, std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (result_.err.find(text) == std::string::npos) {
    if (Clock::now() >= deadline || !Collect(deadline)) return false;
  }
  return true;
}

CommandResult RunningCommand::Wait(std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (Collect(deadline)) {
    if (Clock::now() < deadline) continue;
    result_.timed_out = true;
    kill(pid_, SIGKILL);
    break;
  }
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  result_.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result_;
}

std::string OssaPath() { return (BinaryFolder() / "bin/ossa").string(); }

RunningCommand StartOssa(const std::vector<std::string>& arguments) {
  std::vector<std::string> argv = {OssaPath()};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  return RunningCommand(argv);
}

CommandResult RunOssa(const std::vector<std::string>& arguments,
                      std::chrono::milliseconds timeout) {
  return StartOssa(arguments).Wait(timeout);
}

CommandResult RunProgram(const std::vector<std::string>& argv, std::chrono::milliseconds timeout) {
  return RunningCommand(argv).Wait(timeout);
}

int LineCount(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace ossa::test
