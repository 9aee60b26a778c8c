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

/// Where the rows of an image's leaves are.
struct LeafRows {
  std::vector<LeafView> tables;  // one a tree
  std::span<const int32_t> at;   // sample × tree: the leaf's place in the tree's tables
  std::vector<int32_t> own_at;   // what `at` reads, where places are no leaves' numbers
  std::vector<std::shared_ptr<const GatheredLeaves>> held;  // which are read
};

/// Tables of leaves that are made while the model already runs: those of all leaves take longer
/// than all else of a start, and an image meets a leaf of fifty. Images first have tables made of
/// the leaves that they meet; after a few a thread makes those of all, tree by tree, at times when
/// nobody else wants the processor. Which of them an image got shows nowhere: rows are the same.
/// Safe to share between threads; what a process inherits that is forked meanwhile works, without
/// the thread.
class DeferredLeaves {
 public:
  DeferredLeaves(std::unique_ptr<const LeafTableMaker> maker, std::vector<LeafSource> sources);
  /// Where somebody is to be called once all is there, makes first what the thread has left.
  ~DeferredLeaves();
  DeferredLeaves(const DeferredLeaves&) = delete;
  DeferredLeaves& operator=(const DeferredLeaves&) = delete;

  /// The rows of leaves where walks ended; sample × tree. What comes back reads `leaf`.
  LeafRows Find(std::span<const int32_t> leaf);

  /// Has `then` called as soon as all tables are there, by the thread that made them. Precondition:
  /// nothing was found yet.
  void OnceWhole(std::function<void()> then) { once_whole_ = std::move(then); }

  /// Precondition: they are there.
  const LeafTables& whole(size_t tree) const { return trees_[tree].tables; }

 private:
  struct OneTree {
    std::atomic<bool> is_whole = false;  // `tables` stay as they are from then on
    LeafTables tables;
    std::atomic<int> readers = 0;  // without which what is below may go
    std::unique_ptr<const LeafSource> source;
    std::mutex mutex;  // of `gathered`
    std::shared_ptr<GatheredLeaves> gathered;
  };

  void Gather(OneTree* tree, std::span<const int32_t> leaf, std::span<int32_t> at, LeafRows* rows);
  void StartMakingAll();
  void MakeBesideOthers();
  void MakeAll();
  bool MakeTree(OneTree* tree);

  std::unique_ptr<const LeafTableMaker> maker_;
  std::vector<OneTree> trees_;
  std::function<void()> once_whole_;  // null: it was called
  std::atomic<int> found_ = 0;        // images
  std::atomic<bool> stop_ = false;
  std::thread thread_;
  const pid_t process_;  // that the thread runs in
};

}  // namespace ossa::forest
