#include "tools/commands/process.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include "tools/commands/command.h"

namespace ossa::commands {
namespace {

// The time of the first interruption, steady clock; 0: none yet.
volatile std::sig_atomic_t interrupted = 0;
volatile int64_t interrupted_at_ms = 0;

int64_t Now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // allowed in a signal handler
  return int64_t{1000} * now.tv_sec + now.tv_nsec / 1'000'000;
}

// timeout(1), mpirun and scripts may send the same signal to the process and to its group: two
// within this time count as one.
void HandleInterrupt(int signal) {
  constexpr int64_t kImpatient_ms = 500;  // by hand
  const int64_t now_ms = Now_ms();
  if (interrupted == 0) {
    interrupted_at_ms = now_ms;
    interrupted = 1;
  } else if (now_ms - interrupted_at_ms >= kImpatient_ms) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

// Not SIG_IGN, which started programs would inherit.
void FailTheWrite(int) {}

}  // namespace

bool Interrupted() { return interrupted != 0; }

void PrepareProcess() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // open() returns the lowest free number, which is this one; it is opened for reading, so that
    // printing to it fails.
    if (open("/dev/null", O_RDONLY) != stream) break;
  }
  std::signal(SIGINT, HandleInterrupt);
  std::signal(SIGTERM, HandleInterrupt);
  if (std::signal(SIGHUP, HandleInterrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, FailTheWrite);
  std::signal(SIGXFSZ, FailTheWrite);
}

void PrintError(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

bool CanMoveCursor() {
  const char* terminal = std::getenv("TERM");
  const bool is_dumb = terminal != nullptr && std::strcmp(terminal, "dumb") == 0;
  return isatty(STDERR_FILENO) != 0 && !is_dumb;
}

bool HasColours() {
  const char* without = std::getenv("NO_COLOR");
  return CanMoveCursor() && (without == nullptr || *without == '\0');
}

int EndOutput(int status, int error_number) {
  errno = error_number;
  const bool failed_before = std::ferror(stdout) != 0;
  if (std::fflush(stdout) == 0 && !failed_before) return status;
  if (errno == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  if (status == 0) {
    PrintError(std::string("ossa: standard output: cannot be written") +
               (errno != 0 ? std::string(": ") + std::strerror(errno) : "") + "\n");
  }
  return status == 0 ? 1 : status;
}

}  // namespace ossa::commands
