// Most entries of a leaf represent a few pixels each, which is noise. Pruning them does not reduce
// accuracy and saves a third of the file.
#include "forest/prune.h"

#include "depth/base/error.h"

namespace ossa::forest {
namespace {

constexpr unsigned kTopWeight = 127;  // of the format

Tree Thinned(const Tree& tree, unsigned least_weight) {
  Tree thin = tree;
  thin.entries.clear();
  for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    for (uint32_t i = tree.entry_begin[leaf]; i < tree.entry_begin[leaf + 1]; ++i) {
      if (static_cast<unsigned>(tree.entries[i] >> 9U) >= least_weight) {
        thin.entries.push_back(tree.entries[i]);
      }
    }
    thin.entry_begin[leaf + 1] = static_cast<uint32_t>(thin.entries.size());
  }
  return thin;
}

ForestData Thinned(ForestData data, unsigned least_weight) {
  for (Tree& tree : data.trees) tree = Thinned(tree, least_weight);
  return data;
}

}  // namespace

ForestModel FitInto(const ForestModel& model, uint64_t bytes) {
  const uint64_t whole = FileSize(model.data());
  if (whole <= bytes) return model;
  // Searches with the fast packing, scaled to the final size, then verifies with the real one.
  const double ratio =
      static_cast<double>(whole) / static_cast<double>(FileSize(model.data(), Packing::kQuick));
  unsigned low = 1;  // too large
  unsigned high = kTopWeight;
  while (high - low > 1) {
    const unsigned middle = (low + high) / 2;
    const uint64_t quick = FileSize(Thinned(model.data(), middle), Packing::kQuick);
    (static_cast<double>(quick) * ratio <= static_cast<double>(bytes) ? high : low) = middle;
  }
  for (unsigned least = high; least <= kTopWeight; ++least) {
    ForestData thin = Thinned(model.data(), least);
    if (FileSize(thin) <= bytes) return ForestModel(std::move(thin));
  }
  throw InputError("the model does not fit " + std::to_string(bytes) +
                   " bytes, even with one entry a leaf: allow more, or train fewer or lower trees");
}

}  // namespace ossa::forest
