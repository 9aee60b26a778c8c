// P. Plantard, H. P. H. Shum, F. Multon, 2016, section 6.2.
#include "recon/methods/pose_graph_search_internal.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace ossa::recon {
namespace {

// By hand: scored in a tenth of a millisecond. Up to twice as many nodes are all scored.
constexpr int kCoarse = 2048;

struct Score {
  float similar = 0.0F;     // Ss
  float continuous = 0.0F;  // Sc
  float Total() const { return (similar + continuous) / kJointCount; }
};

/// Ss of eq. 6 and Sc, as mean weighted distances.
class Scorer {
 public:
  explicit Scorer(const PoseQuery& query) : query_(query) {
    for (size_t i = 0; i < kJointCount; ++i) {
      r_[i] = static_cast<float>(query.reliability[i]);
      trust_ += r_[i];
    }
  }
  Score Of(const float* posture) {
    Score score;
    for (size_t i = 0; i < kJointCount; ++i) {
      const Eigen::Map<const Eigen::Vector3f> joint(posture + 3 * i);
      const auto at = FirstCoordinate(i);
      if (r_[i] > 0.0F) score.similar += r_[i] * (query_.observed.segment<3>(at) - joint).norm();
      if (query_.predicted && r_[i] < 1.0F) {
        score.continuous += (1.0F - r_[i]) * (query_.predicted->segment<3>(at) - joint).norm();
      }
    }
    least_similar_ = std::min(least_similar_, score.similar / trust_);
    return score;
  }
  double similarity_m() const { return static_cast<double>(least_similar_); }

 private:
  const PoseQuery& query_;
  JointArray<float> r_{};
  float trust_ = 1e-6F;
  float least_similar_ = std::numeric_limits<float>::max();
};

using Scored = std::pair<float, int>;  // score, node

PoseSelection Selected(std::vector<Scored> scored, size_t k, double similarity_m) {
  const size_t keep = std::min(scored.size(), k);
  std::partial_sort(scored.begin(), scored.begin() + static_cast<ptrdiff_t>(keep), scored.end());
  PoseSelection selection;
  selection.similarity_m = similarity_m;
  for (size_t i = 0; i < keep; ++i) selection.nodes.push_back(scored[i].second);
  return selection;
}

/// The k best nodes found by the search, and which of them have been expanded.
class Beam {
 public:
  Beam(size_t k, size_t nodes) : k_(std::max<size_t>(k, 1)), known_(nodes) {}
  /// Whether the node is new; marks it as visited.
  bool Meet(int node) {
    const auto at = static_cast<size_t>(node);
    if (known_[at]) return false;
    known_[at] = true;
    return true;
  }
  void Offer(Scored scored) {
    if (best_.size() == k_ && scored >= best_.back().scored) return;
    const Entry entry{scored, false};
    best_.insert(
        std::upper_bound(best_.begin(), best_.end(), entry,
                         [](const Entry& a, const Entry& b) { return a.scored < b.scored; }),
        entry);
    if (best_.size() > k_) best_.pop_back();
  }
  /// The best unexpanded node; marks it as expanded.
  std::optional<int> TakeNext() {
    for (Entry& entry : best_) {
      if (!std::exchange(entry.expanded, true)) return entry.scored.second;
    }
    return std::nullopt;
  }
  std::vector<Scored> Best() const {
    std::vector<Scored> best;
    for (const Entry& entry : best_) best.push_back(entry.scored);
    return best;
  }

 private:
  struct Entry {
    Scored scored;
    bool expanded = false;
  };
  size_t k_;
  std::vector<bool> known_;
  std::vector<Entry> best_;  // best first
};

}  // namespace

PoseGraphSearch::PoseGraphSearch(std::shared_ptr<const PostureDatabase> database)
    : database_(std::move(database)) {
  const int n = database_->size();
  if (n <= 2 * kCoarse) return;
  coarse_postures_.resize(kPostureDims, kCoarse);
  for (int c = 0; c < kCoarse; ++c) {
    coarse_.push_back(static_cast<int>(int64_t{c} * n / kCoarse));
    coarse_postures_.col(c) = database_->postures().col(coarse_.back());
  }
}

PoseSelection PoseGraphSearch::SelectBest(std::span<const int> nodes, const PoseQuery& query,
                                          size_t k) const {
  Scorer scorer(query);
  std::vector<Scored> scored;
  scored.reserve(nodes.size());
  const float* postures = database_->postures().data();
  for (const int node : nodes) {
    const float* posture = postures + static_cast<size_t>(node) * kPostureDims;
    scored.emplace_back(scorer.Of(posture).Total(), node);
  }
  return Selected(std::move(scored), k, scorer.similarity_m());
}

PoseSelection PoseGraphSearch::SelectBestOfAll(const PoseQuery& query, size_t k,
                                               std::span<const int> start) const {
  if (!coarse_.empty()) return Descend(query, k, start);
  std::vector<int> all(static_cast<size_t>(database_->size()));
  std::iota(all.begin(), all.end(), 0);
  return SelectBest(all, query, k);
}

PoseSelection PoseGraphSearch::Descend(const PoseQuery& query, size_t k,
                                       std::span<const int> start) const {
  Scorer scorer(query);
  Beam beam(k, static_cast<size_t>(database_->size()));
  for (size_t c = 0; c < coarse_.size(); ++c) {
    const float* posture = coarse_postures_.data() + c * kPostureDims;
    beam.Meet(coarse_[c]);
    beam.Offer({scorer.Of(posture).Total(), coarse_[c]});
  }
  const float* postures = database_->postures().data();
  const auto look_at = [&](int node) {
    if (!beam.Meet(node)) return;
    const float* posture = postures + static_cast<size_t>(node) * kPostureDims;
    beam.Offer({scorer.Of(posture).Total(), node});
  };
  for (const int node : start) look_at(node);
  while (const auto next = beam.TakeNext()) {
    for (const int node : database_->neighbours(*next)) look_at(node);
  }
  return Selected(beam.Best(), k, scorer.similarity_m());
}

}  // namespace ossa::recon
