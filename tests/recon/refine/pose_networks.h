#pragma once
#include <array>

#include "recon/refine/pose_network.h"

namespace ossa::recon::test {

/// A pose network of few channels whose weights are nought but for what is set by hand: of layer
/// kHead the biases are what every cell votes.
inline PoseNetwork::Layers SilentLayers() {
  struct Shape {
    int size = 0, stride = 0;
    Eigen::Index inputs, outputs;
  };
  constexpr Eigen::Index kVotes = 5 * kJointCount;
  constexpr std::array<Shape, PoseNetwork::kLayers> kShapes = {{{5, 2, 3, 2},
                                                                {3, 2, 2, 3},
                                                                {3, 2, 3, 4},
                                                                {3, 1, 4, 4},
                                                                {3, 1, 4, 4},
                                                                {3, 2, 4, 6},
                                                                {3, 1, 6, 6},
                                                                {3, 1, 6, 6},
                                                                {3, 1, 6, 6},
                                                                {3, 1, 6, 6},
                                                                {1, 1, 6, 4},
                                                                {3, 1, 4, 5},
                                                                {1, 1, 5, kVotes}}};
  PoseNetwork::Layers layers;
  for (size_t l = 0; l < layers.size(); ++l) {
    const Shape& shape = kShapes[l];
    layers[l] = {shape.size, shape.stride,
                 RowMatrix::Zero(shape.size * shape.size * shape.inputs, shape.outputs),
                 Eigen::RowVectorXf::Zero(shape.outputs)};
  }
  return layers;
}

/// A crop of nothing, its middle straight ahead.
inline PersonCrop EmptyCrop(double range_m) {
  return {*MakeViewFrame({0.0, 0.0, range_m}), std::vector<PersonCrop::Cell>(kCropCells)};
}

}  // namespace ossa::recon::test
