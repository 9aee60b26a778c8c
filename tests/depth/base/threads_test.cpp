#include "depth/base/threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace ossa {
namespace {

// Libraries print nothing. Must be the first test: TBB prints its warning once.
TEST(ParallelFor, SaysNothingOfThreadsThatThereAreNot) {
  testing::internal::CaptureStderr();
  std::atomic<int> done = 0;
  ParallelFor(5000, 2000, [&](size_t) { ++done; });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(done, 5000);
}

TEST(ParallelFor, DoesEverythingOnceWhateverTheThreads) {
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

TEST(ParallelFor, PassesOnWhatIsThrown) {
  const ThreadLimit limit(2);
  EXPECT_THROW(ParallelFor(50,
                           [](size_t i) {
                             if (i == 30) throw std::runtime_error("no");
                           }),
               std::runtime_error);
}

}  // namespace
}  // namespace ossa
