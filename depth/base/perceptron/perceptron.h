#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/base/perceptron/matrix_product.h"

namespace ossa {

/// A layer of a multilayer perceptron: outputs = inputs · weight + bias.
struct PerceptronLayer {
  RowMatrix weight;         // input × output
  Eigen::RowVectorXf bias;  // one an output
};

/// A multilayer perceptron, rectified between its layers (Nair and Hinton 2010), whose inputs are
/// normalised first. Rows of inputs to rows of outputs; the same bits on every machine.
struct Perceptron {
  Eigen::RowVectorXf input_mean, input_scale;  // scale: 1 / standard deviation
  std::vector<PerceptronLayer> layers;         // the last one's outputs are not rectified

  /// True without layers; such a perceptron must not be run.
  bool empty() const { return layers.empty(); }
  RowMatrix Run(const Eigen::Ref<const RowMatrix>& inputs) const;
  /// The inputs of the first layer: centred, in standard deviations, clipped to +-kMostDeviations.
  RowMatrix Normalise(const Eigen::Ref<const RowMatrix>& inputs) const;

  /// Bound of normalised inputs, standard deviations, because inputs outside the range of training
  /// are meaningless. Chosen by hand; part of every shipped model.
  static constexpr float kMostDeviations = 5.0F;
};

}  // namespace ossa
