#pragma once
// Resource limits of reader programs.
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <thread>

namespace ossa::depth {

/// Ends this process with its parent: a library may loop forever on a damaged file.
inline void EndWithTheParent(pid_t parent) {
  std::thread([parent] {
    while (getppid() == parent) std::this_thread::sleep_for(std::chrono::seconds(1));
    _exit(0);
  }).detach();
}

// Sanitizers' shadow memory alone exceeds the limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kHasShadow = true;
#elif defined(__has_feature)
inline constexpr bool kHasShadow =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kHasShadow = false;
#endif

/// Writes to standard output, the pipe to the parent; exits when that is gone.
inline void WriteToParent(const void* data, size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(STDOUT_FILENO, at, size);
    if (written <= 0) _exit(0);  // the reader is gone
    at += written;
    size -= static_cast<size_t>(written);
  }
}

/// Limits the address space to a hundred of the largest frames (by hand), and disables core dumps.
inline void LimitMemory() {
  constexpr rlim_t kMost = rlim_t{2} << 30;  // bytes
  const rlimit limit{kMost, kMost};
  if (!kHasShadow) setrlimit(RLIMIT_AS, &limit);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
}

}  // namespace ossa::depth
