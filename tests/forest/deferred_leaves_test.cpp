#include "forest/deferred_leaves_internal.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <numeric>
#include <thread>

#include "tests/forest/ball_figure.h"

namespace ossa::forest {
namespace {

const Tree& OneTree() { return test::BallModel().data().trees.front(); }

LeafSource SourceOf(const Tree& tree) {
  LeafSource source{{}, tree.entry_begin, tree.entries};
  source.order.resize(tree.leaf_count());
  std::iota(source.order.begin(), source.order.end(), 0);
  return source;
}

// Every step-th leaf of the tree.
std::vector<int32_t> Leaves(int32_t step) {
  std::vector<int32_t> leaves;
  const auto count = static_cast<int32_t>(OneTree().leaf_count());
  for (int32_t leaf = 0; leaf < count; leaf += step) leaves.push_back(leaf);
  return leaves;
}

// The rows of a leaf, at any index.
std::vector<int> RowsAt(const LeafView& tables, size_t place, size_t contexts) {
  std::vector<int> rows;
  for (size_t k = 0; k < contexts; ++k) {
    rows.push_back(tables.evidence[place * contexts + k]);
    const ShareRow& row = tables.SharesOf(place, k, contexts);
    rows.insert(rows.end(), row.column.begin(), row.column.end());
    rows.insert(rows.end(), row.share.begin(), row.share.end());
  }
  return rows;
}

class GatheredLeavesOfATree : public ::testing::Test {
 protected:
  std::vector<int32_t> Gather(const std::vector<int32_t>& leaf) {
    std::vector<int32_t> at(leaf.size());
    gathered_.Gather(maker_, source_, leaf, 1, at);
    return at;
  }

  const LeafTableMaker maker_{test::BallModel().data()};
  const LeafSource source_ = SourceOf(OneTree());
  GatheredLeaves gathered_{OneTree().leaf_count(), OneTree().leaf_count()};
};

TEST_F(GatheredLeavesOfATree, AreMadeOnce) {
  const std::vector<int32_t> leaves = Leaves(3), at = Gather(leaves);
  const int16_t* const evidence = gathered_.View().evidence;
  EXPECT_EQ(gathered_.count(), leaves.size());
  EXPECT_EQ(Gather(leaves), at);
  Gather(Leaves(6));
  EXPECT_EQ(gathered_.count(), leaves.size());
  Gather(Leaves(1));
  EXPECT_EQ(gathered_.count(), OneTree().leaf_count());
  EXPECT_EQ(gathered_.View().evidence, evidence) << "they stay where they are";
}

TEST_F(GatheredLeavesOfATree, HaveTheRowsOfTheWholeTree) {
  const size_t contexts = test::BallModel().data().context_names.size();
  const LeafTables whole = maker_.Make({source_.entry_begin, source_.entries}, source_.order);
  for (const int32_t step : {5, 2, 1}) {
    const std::vector<int32_t> leaves = Leaves(step), at = Gather(leaves);
    for (size_t i = 0; i < leaves.size(); ++i) {
      ASSERT_EQ(RowsAt(gathered_.View(), static_cast<size_t>(at[i]), contexts),
                RowsAt(whole.View(), static_cast<size_t>(leaves[i]), contexts));
    }
  }
}

std::unique_ptr<DeferredLeaves> Defer(LeafSource source) {
  std::vector<LeafSource> sources;
  sources.push_back(std::move(source));
  return std::make_unique<DeferredLeaves>(
      std::make_unique<const LeafTableMaker>(test::BallModel().data()), std::move(sources));
}

TEST(DeferredLeaves, AreMadeAtALowPriority) {
  const auto deferred = Defer(SourceOf(OneTree()));
  std::promise<int> priority;
  deferred->OnceWhole([&] { priority.set_value(getpriority(PRIO_PROCESS, 0)); });
  const std::vector<int32_t> leaves = Leaves(7);
  for (int image = 0; image < 8; ++image) deferred->Find(leaves);
  constexpr int kLeast = 19;  // of setpriority(2): these tests may have been started by nice(1)
  EXPECT_EQ(priority.get_future().get(), std::min(kLeast, getpriority(PRIO_PROCESS, 0) + 10));
}

// So many leaves that building their rows takes a tenth of a second: the tree's leaves, repeated.
LeafSource LargeSource(size_t leaves) {
  const LeafSource small = SourceOf(OneTree());
  LeafSource source;
  source.order.resize(leaves);
  std::iota(source.order.begin(), source.order.end(), 0);
  source.entry_begin.push_back(0);
  for (size_t i = 0; i < leaves; ++i) {
    const size_t leaf = i % small.order.size();
    source.entries.insert(source.entries.end(), small.entries.begin() + small.entry_begin[leaf],
                          small.entries.begin() + small.entry_begin[leaf + 1]);
    source.entry_begin.push_back(static_cast<uint32_t>(source.entries.size()));
  }
  return source;
}

// The other thread is interrupted by the fork: locks that it holds are never released in the child.
TEST(DeferredLeaves, AreCompleteInAProcessForkedWhileTheyAreMade) {
  constexpr unsigned kPatience_s = 20;
  const auto deferred = Defer(LargeSource(400'000));
  std::vector<int32_t> all(400'000);
  std::iota(all.begin(), all.end(), 0);
  std::atomic<bool> has_begun = false;
  std::thread other([&] {
    has_begun = true;
    deferred->Find(all);
  });
  while (!has_begun) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const pid_t child = fork();
  if (child == 0) {
    alarm(kPatience_s);  // ends a child that waits for what is not there
    _exit(deferred->Find(Leaves(7)).own_at.empty() ? 1 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  other.join();
  ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace ossa::forest
