#include "forest/deferred_leaves_internal.h"

#include <oneapi/tbb/task_arena.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <system_error>
#include <utility>

#include "depth/base/large_pages.h"

namespace ossa::forest {
namespace {

// Number of images with their own tables before all tables are built: commands on a few stills
// finish sooner, and a camera delivers as many in a quarter of a second.
constexpr int kFewImages = 8;  // by hand

// Nice value relative to the process: the thread gets about a tenth of a contended processor. By
// hand: with less, the destructor would wait long for its current step.
constexpr int kLowerPriority = 10;

// Counts readers without a lock, which a forked process could inherit locked.
class Reader {
 public:
  explicit Reader(std::atomic<int>& readers) : readers_(readers) { ++readers_; }
  ~Reader() { --readers_; }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

 private:
  std::atomic<int>& readers_;
};

}  // namespace

DeferredLeaves::DeferredLeaves(std::unique_ptr<const LeafTableMaker> maker,
                               std::vector<LeafSource> sources)
    : maker_(std::move(maker)), trees_(sources.size()), process_(getpid()) {
  for (size_t t = 0; t < trees_.size(); ++t) {
    trees_[t].source = std::make_unique<const LeafSource>(std::move(sources[t]));
  }
}

DeferredLeaves::~DeferredLeaves() {
  stop_ = true;
  if (getpid() != process_) {
    if (thread_.joinable()) thread_.detach();  // it exists only in the parent process
    return;
  }
  if (thread_.joinable()) thread_.join();
  if (once_whole_ == nullptr || found_ < kFewImages) return;
  stop_ = false;
  for (OneTree& tree : trees_) {  // allocate the results
    tree.gathered.reset();
    if (!tree.is_whole) tree.tables = {};
  }
  ReturnFreedMemory();
  MakeAll();
}

// The first element of `leaf` and `at` belongs to this tree. If another thread is gathering, this
// one does not wait, because after a fork that thread may not exist; it makes its own rows.
void DeferredLeaves::Gather(OneTree* tree, std::span<const int32_t> leaf, std::span<int32_t> at,
                            LeafRows* rows) {
  const LeafSource& source = *tree->source;
  const size_t samples = (leaf.size() + trees_.size() - 1) / trees_.size();
  std::shared_ptr<GatheredLeaves> gathered;
  const std::unique_lock lock(tree->mutex, std::try_to_lock);
  // Moved out until success: allocation may fail.
  if (lock.owns_lock()) gathered = std::move(tree->gathered);
  if (gathered == nullptr || !gathered->HasRoomFor(samples)) {
    gathered = std::make_shared<GatheredLeaves>(source.order.size(), samples);
  }
  gathered->Gather(*maker_, source, leaf, trees_.size(), at);
  rows->tables.push_back(gathered->View());
  rows->held.push_back(gathered);
  if (lock.owns_lock()) tree->gathered = std::move(gathered);
}

LeafRows DeferredLeaves::Find(std::span<const int32_t> leaf) {
  LeafRows rows;
  rows.at = leaf;
  for (size_t t = 0; t < trees_.size(); ++t) {
    OneTree& tree = trees_[t];
    const Reader reader(tree.readers);
    if (tree.is_whole) {
      rows.tables.push_back(tree.tables.View());
      continue;
    }
    if (rows.own_at.empty()) rows.own_at.assign(leaf.begin(), leaf.end());
    const size_t first = std::min(t, leaf.size());
    const std::span<int32_t> at = rows.own_at;
    Gather(&tree, leaf.subspan(first), at.subspan(first), &rows);
    rows.at = rows.own_at;
  }
  if (!rows.held.empty() && ++found_ == kFewImages) StartMakingAll();
  return rows;
}

void DeferredLeaves::StartMakingAll() {
  if (getpid() != process_) return;
  try {
    thread_ = std::thread([this] { MakeBesideOthers(); });
  } catch (const std::system_error&) {
    // Without a thread, tables are still made per image.
  }
}

// On one processor only: the others are needed for tracking. On Linux 0 means this thread, not the
// process.
void DeferredLeaves::MakeBesideOthers() {
  setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + kLowerPriority);
  oneapi::tbb::task_arena arena(1);
  arena.execute([this] { MakeAll(); });
}

void DeferredLeaves::MakeAll() try {
  for (OneTree& tree : trees_) {
    if (!tree.is_whole && !MakeTree(&tree)) return;
  }
  if (once_whole_) once_whole_();
  once_whole_ = nullptr;
} catch (const std::exception&) {
  // Without enough memory, tables are still made per image.
}

bool DeferredLeaves::MakeTree(OneTree* tree) {
  const LeafSource& source = *tree->source;
  tree->tables = maker_->Make({source.entry_begin, source.entries}, source.order, &stop_);
  if (stop_) return false;
  tree->is_whole = true;
  while (tree->readers > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  tree->source.reset();
  tree->gathered.reset();
  ReturnFreedMemory();  // before the next tree's tables are allocated
  return true;
}

}  // namespace ossa::forest
