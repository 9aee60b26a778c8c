#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "depth/base/perceptron/matrix_product.h"
#include "forest/proposals/propose.h"

namespace ossa::forest {

/// Where the targets of an object were proposed, the best place of each; one array a coordinate for
/// the vector units. A target that was not proposed is too far away to be near anything.
struct Anchors {
  std::vector<float> x, y, z;  // metres
  std::vector<float> confidence;

  explicit Anchors(const std::vector<std::vector<Proposal>>& proposals);
};

/// How near points (a row each) are to the anchors: point × (scale · target), kRadialBasisScales of
/// them (forest.h), all in [0, 1].
RowMatrix ComputeRadialBasis(const Anchors& anchors, const std::vector<Eigen::Vector3f>& points_m);

/// Added to probabilities of the trees: a class that no leaf gave a pixel is not impossible.
inline constexpr float kLeastLeafProbability = 1e-3F;  // by hand

}  // namespace ossa::forest
