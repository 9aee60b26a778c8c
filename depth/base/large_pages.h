#pragma once
#include <cstddef>
#include <vector>

namespace ossa {

/// Requests 2 MB pages for this memory, as far as whole pages fit: random access to large tables
/// would otherwise miss the TLB on most reads. Best effort: without large pages everything works,
/// more slowly.
void PreferLargePages(const void* memory, size_t bytes);

/// Zeroed memory in large pages: clearing one large page is faster than faulting in 512 small ones.
template <typename T>
std::vector<T> MakeLargeVector(size_t count) {
  std::vector<T> numbers;
  numbers.reserve(count);
  PreferLargePages(numbers.data(), count * sizeof(T));
  numbers.resize(count);
  return numbers;
}

/// Returns freed memory to the system before another large allocation; otherwise the buffers of a
/// file would still count. Best effort, too.
void ReturnFreedMemory();

}  // namespace ossa
