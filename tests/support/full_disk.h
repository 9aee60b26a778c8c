#pragma once
#include <signal.h>
#include <sys/resource.h>

#include <cstdint>

namespace ossa::test {

/// During its lifetime no file of this process grows beyond that many bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(uint64_t bytes) : handler_before_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, handler_before_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_before_;
};

}  // namespace ossa::test
