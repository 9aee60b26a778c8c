#include "forest/training/leaves_internal.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "depth/base/random.h"
#include "forest/runtime_tables_internal.h"

namespace ossa::forest {
namespace {

// Constants: of the format, the rest by hand.

constexpr size_t kMaxEntries = 24;                    // per leaf; the rest is noise of a few pixels
constexpr uint32_t kTopWeight = 127;                  // 7 bits
constexpr double kWeightStep = 0.5458;                // 127 to 1 in eight equal ratios
constexpr uint64_t kLeastShare = uint64_t{1} << 30U;  // a quarter
constexpr size_t kVoteEvery = 4;  // one in this many sampled pixels votes for positions
constexpr int kTrimPasses = 2;    // mean shift steps from the mean to the mode
constexpr int64_t kTrimRadius_mm = 150;
constexpr int64_t kSpreadCap_mm = 300;  // outliers are clipped

// Statistics of one target over the pixels of a vote row. Whole millimetres.
struct VoteSum {
  int64_t count = 0;
  int64_t x = 0, y = 0, z = 0;
  int64_t all = 0;      // number of pixels, inside the trim radius or not
  int64_t squares = 0;  // sum over all pixels of squared clipped distances to the previous mean
};
constexpr size_t kFields = sizeof(VoteSum) / sizeof(int64_t);

void Add(int64_t* to, int64_t value) {
  std::atomic_ref<int64_t>(*to).fetch_add(value, std::memory_order_relaxed);
}

// The leaf of each sample of an image in one tree.
std::vector<int32_t> FindLeaves(const LinedTree& tree, const StoredImage& image, size_t step) {
  std::vector<int32_t> position;
  for (size_t i = 0; i < image.samples.size(); i += step) {
    position.push_back((image.samples[i].y << 16) | image.samples[i].x);
  }
  std::vector<int32_t> leaf(position.size());
  Walk({&tree, &image.image, position}, leaf.data(), 1);
  for (int32_t& each : leaf) each = tree.leaf[static_cast<size_t>(each)];
  return leaf;
}

// Contexts are balanced: each image of contexts more frequent than the rarest counts with this
// probability, of 2^32. Otherwise rare contexts would vanish in leaves with few pixels. At least a
// quarter counts: a context with a single image must not empty the leaves of all others.
std::vector<uint64_t> BalancedShares(const ImageParts& parts, const Reducer& reducer,
                                     size_t context_count) {
  std::vector<int64_t> images(context_count);
  for (size_t k = 0; k < context_count; ++k) {
    images[k] = static_cast<int64_t>(parts.context_count(k));
  }
  reducer.Sum(std::span<int64_t>(images));
  int64_t rarest = 0;
  for (const int64_t n : images) {
    if (n > 0 && (rarest == 0 || n < rarest)) rarest = n;
  }
  std::vector<uint64_t> shares;
  for (const int64_t n : images) {
    const auto most = static_cast<uint64_t>(std::max<int64_t>(n, 1));
    shares.push_back(std::max((static_cast<uint64_t>(rarest) << 32U) / most, kLeastShare));
  }
  return shares;
}

void CountCells(const Tree& tree, const ImageParts& parts, size_t class_count,
                const std::vector<uint64_t>& shares, std::vector<uint32_t>* counts) {
  constexpr uint64_t kSeed = 0xba1a;
  const size_t cells = class_count * shares.size();
  const LinedTree lined = LayOutInLines(tree.nodes);
  counts->assign(tree.leaf_count() * cells, 0);
  parts.Visit([&](size_t, const std::vector<StoredImage>& images) {
    oneapi::tbb::parallel_for(size_t{0}, images.size(), [&](size_t i) {
      const StoredImage& image = images[i];
      if (Random(MixSeed(kSeed, image.index)).Bits() >> 32U >= shares[image.context]) return;
      const std::vector<int32_t> leaf = FindLeaves(lined, image, 1);
      for (size_t s = 0; s < leaf.size(); ++s) {
        const size_t cell = static_cast<size_t>(leaf[s]) * cells + image.context * class_count +
                            image.samples[s].label;
        std::atomic_ref<uint32_t>((*counts)[cell]).fetch_add(1, std::memory_order_relaxed);
      }
    });
  });
}

// Quantises weights logarithmically: finer steps are below the noise of the few pixels they
// represent, and cost three bits each.
uint32_t RoundedWeight(uint32_t weight) {
  const double top = kTopWeight;
  const double steps = std::round(std::log(weight / top) / std::log(kWeightStep));
  return std::max(1U, static_cast<uint32_t>(std::lround(top * std::pow(kWeightStep, steps))));
}

void PackEntries(const std::vector<uint32_t>& counts, size_t cells, Tree* tree) {
  for (size_t leaf = 0; leaf + 1 < tree->entry_begin.size(); ++leaf) {
    std::vector<std::pair<uint32_t, uint32_t>> present;  // count, cell
    for (size_t cell = 0; cell < cells; ++cell) {
      const uint32_t n = counts[leaf * cells + cell];
      if (n > 0) present.emplace_back(n, static_cast<uint32_t>(cell));
    }
    std::sort(present.begin(), present.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    if (present.size() > kMaxEntries) present.resize(kMaxEntries);
    const uint64_t top = present.empty() ? 1 : present.front().first;
    for (const auto& [n, cell] : present) {
      const auto weight = static_cast<uint32_t>((n * uint64_t{2} * kTopWeight + top) / (2 * top));
      if (weight == 0) continue;
      tree->entries.push_back(static_cast<uint16_t>(RoundedWeight(weight) << 9U | cell));
    }
    tree->entry_begin[leaf + 1] = static_cast<uint32_t>(tree->entries.size());
  }
}

struct VotePass {
  const std::vector<VoteSum>* before = nullptr;  // results of the previous pass; null in the first
  std::vector<VoteSum>* sums = nullptr;
  size_t contexts = 1;
};

void AddVote(const Eigen::Vector3i& offset_mm, const VoteSum* before, VoteSum* sum) {
  int64_t distance_mm = 0;
  if (before != nullptr && before->count > 0) {
    const Eigen::Vector3d mean =
        Eigen::Vector3d(static_cast<double>(before->x), static_cast<double>(before->y),
                        static_cast<double>(before->z)) /
        static_cast<double>(before->count);
    distance_mm = std::lround((offset_mm.cast<double>() - mean).norm());
    const int64_t capped = std::min(distance_mm, kSpreadCap_mm);
    Add(&sum->squares, capped * capped);
  }
  Add(&sum->all, 1);
  if (distance_mm > kTrimRadius_mm) return;
  Add(&sum->count, 1);
  Add(&sum->x, offset_mm.x());
  Add(&sum->y, offset_mm.y());
  Add(&sum->z, offset_mm.z());
}

void SumVotes(const Tree& tree, const std::vector<int32_t>& row_of_leaf, const ImageParts& parts,
              size_t targets, const VotePass& pass) {
  const LinedTree lined = LayOutInLines(tree.nodes);
  parts.Visit([&](size_t, const std::vector<StoredImage>& images) {
    oneapi::tbb::parallel_for(size_t{0}, images.size(), [&](size_t i) {
      const StoredImage& image = images[i];
      const std::vector<int32_t> leaf = FindLeaves(lined, image, kVoteEvery);
      const size_t contexts = pass.contexts;
      for (size_t s = 0; s < leaf.size(); ++s) {
        const PixelSample& pixel = image.samples[s * kVoteEvery];
        const Eigen::Vector3f at_m =
            depth::BackProject(image.camera, pixel.x, pixel.y,
                               image.image.depth_mm[image.image.At(pixel.x, pixel.y)])
                .cast<float>();
        const auto node = static_cast<size_t>(row_of_leaf[static_cast<size_t>(leaf[s])]);
        const size_t row = (node * contexts + image.context) * targets;
        for (size_t t = 0; t < targets; ++t) {
          if (!image.target_m[t].allFinite()) continue;
          const Eigen::Vector3i offset_mm =
              ((image.target_m[t] - at_m) * 1000.0F).array().round().cast<int>();
          AddVote(offset_mm, pass.before == nullptr ? nullptr : &(*pass.before)[row + t],
                  &(*pass.sums)[row + t]);
        }
      }
    });
  });
}

Vote PackVote(const VoteSum& place, const VoteSum& last) {
  Vote vote;
  constexpr int64_t kFewest = 8;  // pixels
  if (last.all < kFewest || place.count == 0) return vote;
  const std::array<int64_t, 3> sum = {place.x, place.y, place.z};
  for (size_t i = 0; i < 3; ++i) {
    const long cm =
        std::lround(static_cast<double>(sum[i]) / static_cast<double>(place.count) / 10);
    if (cm < -127 || cm > 127) return vote;  // beyond the range of a vote
    vote.offset_cm[i] = static_cast<int8_t>(cm);
  }
  const double spread_cm =
      std::sqrt(static_cast<double>(last.squares) / static_cast<double>(last.all)) / 10;
  vote.spread_cm = static_cast<uint8_t>(std::lround(spread_cm));
  return vote;
}

void FillVotes(const ImageParts& parts, const Reducer& reducer, size_t contexts, size_t targets,
               Tree* tree) {
  size_t rows = 0;
  const std::vector<int32_t> row_of_leaf = VoteRows(*tree, &rows);
  rows *= contexts;
  std::vector<VoteSum> before;
  std::vector<VoteSum> sums;
  for (int pass = 0; pass <= kTrimPasses; ++pass) {
    before = std::move(sums);
    sums.assign(rows * targets, VoteSum{});
    SumVotes(*tree, row_of_leaf, parts, targets, {pass == 0 ? nullptr : &before, &sums, contexts});
    reducer.Sum(std::span<int64_t>(reinterpret_cast<int64_t*>(sums.data()), sums.size() * kFields));
  }
  tree->votes.resize(rows * targets);
  for (size_t i = 0; i < sums.size(); ++i) {
    tree->votes[i] = PackVote(sums[i].count > 0 ? sums[i] : before[i], sums[i]);
  }
}

// Rounds offsets to half a pixel·metre (a quarter of a pixel at 2 m): saves a fifth of a node's
// bytes. Leaves are filled afterwards, so they are consistent with it; the rare leaf that loses all
// its pixels has no entries and defers to the other trees.
void RoundOffsets(Node* node) {
  constexpr int kUnits = 8;
  for (std::array<int16_t, 2>* offset : {&node->u, &node->v}) {
    for (int16_t& value : *offset) {
      value = static_cast<int16_t>(kUnits * std::lround(static_cast<double>(value) / kUnits));
    }
  }
}

}  // namespace

Tree NumberLeaves(const std::vector<Node>& nodes, int vote_depth) {
  Tree tree;
  tree.nodes = nodes;
  tree.vote_depth = vote_depth;
  int32_t leaves = 0;
  for (Node& node : tree.nodes) {
    RoundOffsets(&node);
    if (node.is_leaf()) node.left = ~leaves++;
  }
  tree.entry_begin.assign(static_cast<size_t>(leaves) + 1, 0);
  return tree;
}

void FillLeaves(const ImageParts& parts, const Reducer& reducer, size_t class_count,
                size_t context_count, size_t target_count, std::vector<Tree>* trees) {
  const size_t cells = class_count * context_count;
  const std::vector<uint64_t> shares = BalancedShares(parts, reducer, context_count);
  std::vector<uint32_t> counts;
  for (Tree& tree : *trees) {
    CountCells(tree, parts, class_count, shares, &counts);
    reducer.Sum(std::span<uint32_t>(counts));
    PackEntries(counts, cells, &tree);
    if (target_count > 0) FillVotes(parts, reducer, context_count, target_count, &tree);
  }
}

}  // namespace ossa::forest
