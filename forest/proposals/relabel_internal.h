#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "depth/base/perceptron/matrix_product.h"
#include "forest/proposals/propose.h"

namespace ossa::forest {

/// The best proposed position of each target of an object, one array per coordinate for
/// vectorisation. Targets without a proposal are too far away to matter.
struct Anchors {
  std::vector<float> x, y, z;  // metres
  std::vector<float> confidence;

  explicit Anchors(const std::vector<std::vector<Proposal>>& proposals);
};

/// Radial basis functions of points (one per row) around the anchors: point × (scale · target),
/// with kRadialBasisScales scales (forest.h), all in [0, 1].
RowMatrix ComputeRadialBasis(const Anchors& anchors, const std::vector<Eigen::Vector3f>& points_m);

/// Added to the trees' probabilities: classes without any leaf mass remain possible.
inline constexpr float kLeastLeafProbability = 1e-3F;  // by hand

}  // namespace ossa::forest
