#include "forest/deferred_leaves_internal.h"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include "depth/base/large_pages.h"

namespace ossa::forest {
namespace {

// Images that get tables of their own before those of all leaves are made: a command that looks at
// a still or two is done before, and a camera's are past in a quarter of a second.
constexpr int kFewImages = 8;  // by hand

// Tables of the leaves that one tree's walks ended at, each once; `at` receives where in them each
// sample's leaf stands. Both sample × tree, of which one column is this tree's.
LeafTables MakeOwn(const LeafTableMaker& maker, const LeafSource& source,
                   std::span<const int32_t> leaf, size_t trees, std::span<int32_t> at) {
  std::vector<int32_t> met, place(source.order.size(), -1);
  for (size_t i = 0; i < leaf.size(); i += trees) {
    int32_t& here = place[static_cast<size_t>(leaf[i])];
    if (here < 0) {
      here = static_cast<int32_t>(met.size());
      met.push_back(source.order[static_cast<size_t>(leaf[i])]);
    }
    at[i] = here;
  }
  return maker.Make({source.entry_begin, source.entries}, met);
}

}  // namespace

DeferredLeaves::DeferredLeaves(std::unique_ptr<const LeafTableMaker> maker,
                               std::vector<LeafSource> sources)
    : maker_(std::move(maker)), trees_(sources.size()) {
  for (size_t t = 0; t < trees_.size(); ++t) {
    trees_[t].source = std::make_shared<const LeafSource>(std::move(sources[t]));
  }
}

DeferredLeaves::~DeferredLeaves() {
  stop_ = once_whole_ == nullptr;
  if (thread_.joinable()) thread_.join();
}

LeafRows DeferredLeaves::Find(std::span<const int32_t> leaf) {
  LeafRows rows;
  rows.at = leaf;
  const size_t trees = trees_.size();
  for (size_t t = 0; t < trees; ++t) {
    OneTree& tree = trees_[t];
    std::shared_ptr<const LeafSource> source;
    if (!tree.is_whole) {
      const std::lock_guard lock(tree.mutex);
      source = tree.source;
    }
    if (source == nullptr) {  // whole, if only by now
      rows.tables.push_back(tree.tables.View());
      continue;
    }
    if (rows.own_at.empty()) rows.own_at.assign(leaf.begin(), leaf.end());
    const size_t first = std::min(t, leaf.size());
    rows.own.push_back(MakeOwn(*maker_, *source, leaf.subspan(first), trees,
                               std::span(rows.own_at).subspan(first)));
    rows.tables.push_back(rows.own.back().View());
    rows.at = rows.own_at;
  }
  if (!rows.own.empty() && ++found_ == kFewImages) StartMakingAll();
  return rows;
}

void DeferredLeaves::StartMakingAll() {
  try {
    thread_ = std::thread([this] { MakeAll(); });
  } catch (const std::system_error&) {
    // Without a thread images go on having tables of their own.
  }
}

// On one processor: the others follow people.
void DeferredLeaves::MakeAll() try {
  oneapi::tbb::task_arena arena(1);
  for (OneTree& tree : trees_) {
    bool is_made = false;
    arena.execute([&] { is_made = MakeTree(&tree); });
    if (!is_made) return;
  }
  if (once_whole_) once_whole_();
} catch (const std::exception&) {
  // Where memory is short images go on having tables of their own.
}

bool DeferredLeaves::MakeTree(OneTree* tree) {
  const LeafSource& source = *tree->source;
  tree->tables = maker_->Make({source.entry_begin, source.entries}, source.order, &stop_);
  if (stop_) return false;
  tree->is_whole = true;
  {
    const std::lock_guard lock(tree->mutex);
    tree->source = nullptr;
  }
  ReturnFreedMemory();  // before the next tree's tables are made
  return true;
}

}  // namespace ossa::forest
