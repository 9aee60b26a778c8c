#pragma once
#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "forest/gathered_leaves_internal.h"

namespace ossa::forest {

/// Locations of the table rows of an image's leaves.
struct LeafRows {
  std::vector<LeafView> tables;  // one per tree
  std::span<const int32_t> at;   // sample × tree: row index of the leaf in the tree's tables
  std::vector<int32_t> own_at;   // storage of `at`, if indices differ from leaf numbers
  std::vector<std::shared_ptr<const GatheredLeaves>> held;  // keeps the tables alive
};

/// Leaf tables that are built while the model already runs: building those of all leaves would
/// dominate start-up, and an image reaches one leaf of fifty. At first, tables are built for the
/// leaves that an image reaches; after a few images a thread builds all, tree by tree, at low
/// priority. Results do not depend on which tables are used: rows are identical. Thread-safe; works
/// in a forked process, without the thread.
class DeferredLeaves {
 public:
  DeferredLeaves(std::unique_ptr<const LeafTableMaker> maker, std::vector<LeafSource> sources);
  /// If a callback is pending, first builds the remaining tables.
  ~DeferredLeaves();
  DeferredLeaves(const DeferredLeaves&) = delete;
  DeferredLeaves& operator=(const DeferredLeaves&) = delete;

  /// The rows of the leaves reached; sample × tree. The result refers to `leaf`.
  LeafRows Find(std::span<const int32_t> leaf);

  /// Calls `then` when all tables are complete, on the thread that built them. Precondition: Find
  /// has not been called.
  void OnceWhole(std::function<void()> then) { once_whole_ = std::move(then); }

  /// Precondition: the tables are complete.
  const LeafTables& whole(size_t tree) const { return trees_[tree].tables; }

 private:
  struct OneTree {
    std::atomic<bool> is_whole = false;  // then `tables` are immutable
    LeafTables tables;
    std::atomic<int> readers = 0;  // the members below may be freed if there are none
    std::unique_ptr<const LeafSource> source;
    std::mutex mutex;  // guards `gathered`
    std::shared_ptr<GatheredLeaves> gathered;
  };

  void Gather(OneTree* tree, std::span<const int32_t> leaf, std::span<int32_t> at, LeafRows* rows);
  void StartMakingAll();
  void MakeBesideOthers();
  void MakeAll();
  bool MakeTree(OneTree* tree);

  std::unique_ptr<const LeafTableMaker> maker_;
  std::vector<OneTree> trees_;
  std::function<void()> once_whole_;  // null: already called
  std::atomic<int> found_ = 0;        // images so far
  std::atomic<bool> stop_ = false;
  std::thread thread_;
  const pid_t process_;  // process of the thread
};

}  // namespace ossa::forest
