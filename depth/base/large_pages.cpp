#include "depth/base/large_pages.h"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace ossa {

void PreferLargePages(const void* memory, size_t bytes) {
#if defined(__linux__)
  // MADV_COLLAPSE of Linux 6.1, missing in older headers; by definition
  constexpr int kCollapse = 25;
  constexpr uintptr_t kPage = uintptr_t{2} << 20U;
  const auto at = reinterpret_cast<uintptr_t>(memory);
  const uintptr_t begin = (at + kPage - 1) / kPage * kPage;
  const uintptr_t end = (at + bytes) / kPage * kPage;
  if (begin >= end) return;
  auto* whole = reinterpret_cast<void*>(begin);
  madvise(whole, end - begin, MADV_HUGEPAGE);
  madvise(whole, end - begin, kCollapse);
#else
  static_cast<void>(memory);
  static_cast<void>(bytes);
#endif
}

void ReturnFreedMemory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace ossa
