#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// The query with which Plantard 2016 compares the nodes of the graph.
struct PoseQuery {
  PostureVector observed = PostureVector::Zero();  // normalised, standard size
  JointWeights reliability{};                      // R_i in [0, 1]
  std::optional<PostureVector> predicted;          // by constant velocity
};

/// The nodes of lowest score S = Ss + Sc (eqs. 6-7), best first.
struct PoseSelection {
  std::vector<int> nodes;
  double similarity_m = 0.0;  // smallest Ss of all scored nodes, per unit of reliability
};

/// Sec. 6.2 over a pose graph of any size.
class PoseGraphSearch {
 public:
  explicit PoseGraphSearch(std::shared_ptr<const PostureDatabase> database);

  /// The k best of the given nodes.
  PoseSelection SelectBest(std::span<const int> nodes, const PoseQuery& query, size_t k) const;
  /// The k best of all nodes. Departure for more than some thousand nodes, all of which the paper
  /// searches: starts from a coarse subset and from `start`, and expands the best nodes along the
  /// graph's edges until the k best have no better neighbours. The cost hardly grows with the
  /// graph; the result may be slightly suboptimal.
  PoseSelection SelectBestOfAll(const PoseQuery& query, size_t k, std::span<const int> start) const;

 private:
  PoseSelection Descend(const PoseQuery& query, size_t k, std::span<const int> start) const;

  std::shared_ptr<const PostureDatabase> database_;
  std::vector<int> coarse_;  // evenly spread over consecutive clips
  Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> coarse_postures_;  // contiguous copy
};

}  // namespace ossa::recon
