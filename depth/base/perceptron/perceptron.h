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

  /// Without layers it says nothing, and must not be run.
  bool empty() const { return layers.empty(); }
  RowMatrix Run(const Eigen::Ref<const RowMatrix>& inputs) const;
  /// What the first layer gets of inputs: about their mean, in standard deviations; outliers are
  /// cut off at kMostDeviations.
  RowMatrix Normalise(const Eigen::Ref<const RowMatrix>& inputs) const;

  /// Standard deviations. What was never seen in training is taken for the most that was. Chosen by
  /// hand; part of every shipped model.
  static constexpr float kMostDeviations = 5.0F;
};

}  // namespace ossa
