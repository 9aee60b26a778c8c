#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/base/perceptron/perceptron_file.h"

namespace ossa::test {

/// A perceptron whose outputs are all 0 until something in it is changed. `sizes`: inputs, units of
/// each hidden layer, outputs.
inline Perceptron SilentPerceptron(const std::vector<Eigen::Index>& sizes) {
  Perceptron perceptron;
  perceptron.input_mean.setZero(sizes.front());
  perceptron.input_scale.setOnes(sizes.front());
  for (size_t l = 1; l < sizes.size(); ++l) {
    perceptron.layers.push_back(
        {RowMatrix::Zero(sizes[l - 1], sizes[l]), Eigen::RowVectorXf::Zero(sizes[l])});
  }
  return perceptron;
}

/// Of random weights (std::srand), as files keep them in bytes.
inline Perceptron RandomPerceptron(const std::vector<Eigen::Index>& sizes) {
  Perceptron perceptron = SilentPerceptron(sizes);
  perceptron.input_mean.setRandom();
  perceptron.input_scale = 3.0F * Eigen::RowVectorXf::Random(sizes.front()).cwiseAbs();
  for (PerceptronLayer& layer : perceptron.layers) {
    layer.weight.setRandom();
    layer.bias.setRandom();
    layer.weight = RoundToBytes(layer.weight).ToWeights();
  }
  return perceptron;
}

}  // namespace ossa::test
