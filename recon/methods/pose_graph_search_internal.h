#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// What Plantard 2016 holds a node of the graph against.
struct PoseQuery {
  PostureVector observed = PostureVector::Zero();  // normalised, standard size
  JointWeights reliability{};                      // R_i in [0, 1]
  std::optional<PostureVector> predicted;          // by constant velocity
};

/// The nodes of lowest score S = Ss + Sc (eqs. 6-7), best first.
struct PoseSelection {
  std::vector<int> nodes;
  double similarity_m = 0.0;  // least Ss of all that were looked at, per unit of reliability
};

/// Sec. 6.2 over a pose graph of any size.
class PoseGraphSearch {
 public:
  explicit PoseGraphSearch(std::shared_ptr<const PostureDatabase> database);

  /// The k best of these nodes.
  PoseSelection SelectBest(std::span<const int> nodes, const PoseQuery& query, size_t k) const;
  /// The k best of all nodes. Departure where there are more than some thousand: the paper searches
  /// all; this begins at a coarse level, one node of many, and at `start`, and goes down the graph
  /// from the best found, node by node, until the k best know no better one. What it costs hardly
  /// grows with the graph; it may end beside the best.
  PoseSelection SelectBestOfAll(const PoseQuery& query, size_t k, std::span<const int> start) const;

 private:
  PoseSelection Descend(const PoseQuery& query, size_t k, std::span<const int> start) const;

  std::shared_ptr<const PostureDatabase> database_;
  std::vector<int>
      coarse_;  // evenly spread: clips stand one after the other, frames in their order
  Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> coarse_postures_;  // a copy, side by side
};

}  // namespace ossa::recon
