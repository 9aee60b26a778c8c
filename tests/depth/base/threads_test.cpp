#include "depth/base/threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace ossa {
namespace {

// Libraries print nothing. Must be the first test: TBB prints its warning once.
TEST(ParallelFor, DoesNotWarnAboutTooManyThreads) {
  testing::internal::CaptureStderr();
  std::atomic<int> done = 0;
  ParallelFor(5000, 2000, [&](size_t) { ++done; });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(done, 5000);
}

TEST(ParallelFor, RunsEveryIndexOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> done(100);
    ParallelFor(done.size(), threads, [&](size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(ParallelFor, IsInOrderOnOneThread) {
  std::vector<size_t> order;
  ParallelFor(20, 1, [&](size_t i) { order.push_back(i); });
  std::vector<size_t> wanted(20);
  std::iota(wanted.begin(), wanted.end(), size_t{0});
  EXPECT_EQ(order, wanted);
}

TEST(ParallelFor, RethrowsExceptions) {
  const ThreadLimit limit(2);
  EXPECT_THROW(ParallelFor(50,
                           [](size_t i) {
                             if (i == 30) throw std::runtime_error("no");
                           }),
               std::runtime_error);
}

double ResidentMegabytes() {
  constexpr double kPage_mb = 4096.0 / (1 << 20);
  double size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident * kPage_mb;
}

// A tracker that runs for days starts such loops in every frame.
TEST(ParallelFor, DoesNotLeakMemory) {
  const auto loop = [](int times) {
    for (int i = 0; i < times; ++i) ParallelFor(2, 2, [](size_t) {});
  };
  loop(100);
  const double before_mb = ResidentMegabytes();
  loop(10000);
  EXPECT_LT(ResidentMegabytes() - before_mb, 10.0) << "7 kB a loop: 70 MB";
}

// Each caller has an arena of its own, the one within another's loop, too.
TEST(WithThreads, IsForSeveralCallersAndWithinLoops) {
  std::atomic<int> done = 0;
  const auto nested = [&] {
    WithThreads(
        2, [&] { ParallelFor(8, 2, [&](size_t) { ParallelFor(4, 2, [&](size_t) { ++done; }); }); });
  };
  std::thread other([&] {
    for (int i = 0; i < 50; ++i) nested();
  });
  for (int i = 0; i < 50; ++i) nested();
  other.join();
  EXPECT_EQ(done, 2 * 50 * 8 * 4);
}

TEST(WithThreads, RethrowsExceptionsAndContinues) {
  for (int i = 0; i < 3; ++i)
    EXPECT_THROW(WithThreads(2, [] { throw std::runtime_error("no"); }), std::runtime_error);
  int done = 0;
  WithThreads(2, [&] { ++done; });
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace ossa
