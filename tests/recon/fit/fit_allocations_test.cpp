// Counts heap allocations of operator new and Eigen's matrices alike: all use malloc.
#include <atomic>
#include <cstdlib>

#include "tests/recon/fit/posed_person.h"

namespace {
std::atomic<size_t> taken_from_heap = 0;
}  // namespace

// Sanitizers replace the heap.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define OSSA_COUNTS 0
#elif defined(__clang__)
#define OSSA_COUNTS !(__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define OSSA_COUNTS 1
#endif

#if OSSA_COUNTS
extern "C" void* __libc_malloc(size_t size);  // NOLINT: glibc's name
extern "C" void* malloc(size_t size) noexcept {
  ++taken_from_heap;
  return __libc_malloc(size);
}
#endif

namespace ossa::recon {
namespace {

TEST(FitAllocations, AreNoneAfterTheFirstFrame) {
  if (!OSSA_COUNTS) GTEST_SKIP() << "the sanitizer has its own heap";
  const SeenSurface seen(RandomPose(1));
  const SurfaceFitInput input = seen.Input(Disturbed(seen.joints_m, 0.05, 1));
  SurfaceFitter fitter(Surface());
  size_t before = taken_from_heap;
  ASSERT_TRUE(fitter.Fit(input));
  EXPECT_GT(taken_from_heap, before);  // the fitter's own memory: proves that counting works
  before = taken_from_heap;
  const auto fit = fitter.Fit(input);
  EXPECT_EQ(taken_from_heap, before);
  EXPECT_TRUE(fit);
}

}  // namespace
}  // namespace ossa::recon
