#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "forest/leaf_tables_internal.h"

namespace ossa::forest {

/// What the tables of one tree's leaves are made of.
struct LeafSource {
  std::vector<int32_t> order;         // of each leaf, in the order of LinedTree: its number in Tree
  std::vector<uint32_t> entry_begin;  // as in Tree
  std::vector<uint16_t> entries;
};

/// Where the rows of an image's leaves are.
struct LeafRows {
  std::vector<LeafView> tables;  // one a tree
  std::span<const int32_t> at;   // sample × tree: the leaf's place in the tree's tables
  std::vector<int32_t> own_at;   // what `at` reads, where places are no leaves' numbers
  std::vector<LeafTables> own;   // tables of this image's leaves alone
};

/// Tables of leaves that are made while the model already runs: those of all leaves take longer
/// than all else of a start, and an image meets a leaf of fifty. Images first get tables of the
/// leaves that they meet; after a few a thread makes those of all, tree by tree. Which of them an
/// image got shows nowhere: rows are the same. Safe to share between threads.
class DeferredLeaves {
 public:
  DeferredLeaves(std::unique_ptr<const LeafTableMaker> maker, std::vector<LeafSource> sources);
  /// Waits for the thread: where somebody is to be called once all is there until it is, else for
  /// what it is at.
  ~DeferredLeaves();
  DeferredLeaves(const DeferredLeaves&) = delete;
  DeferredLeaves& operator=(const DeferredLeaves&) = delete;

  /// The rows of leaves where walks ended; sample × tree. What comes back reads `leaf`.
  LeafRows Find(std::span<const int32_t> leaf);

  /// Has the thread call `then` as soon as all tables are there. Precondition: nothing was found
  /// yet.
  void OnceWhole(std::function<void()> then) { once_whole_ = std::move(then); }

  /// Precondition: they are there.
  const LeafTables& whole(size_t tree) const { return trees_[tree].tables; }

 private:
  struct OneTree {
    std::atomic<bool> is_whole = false;  // `tables` stay as they are from then on
    LeafTables tables;
    std::mutex mutex;  // of `source`
    std::shared_ptr<const LeafSource> source;
  };

  void StartMakingAll();
  void MakeAll();
  bool MakeTree(OneTree* tree);

  std::unique_ptr<const LeafTableMaker> maker_;
  std::vector<OneTree> trees_;
  std::function<void()> once_whole_;
  std::atomic<int> found_ = 0;  // images
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace ossa::forest
