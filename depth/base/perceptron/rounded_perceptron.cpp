#include "depth/base/perceptron/rounded_perceptron.h"

#include <utility>

namespace ossa {

RoundedPerceptron::RoundedPerceptron(const Perceptron& perceptron) {
  normaliser_.input_mean = perceptron.input_mean;
  normaliser_.input_scale = perceptron.input_scale;
  for (const PerceptronLayer& layer : perceptron.layers) {
    layers_.emplace_back(Convolution{1, 1, layer.weight, layer.bias});
  }
}

RowMatrix RoundedPerceptron::Run(const Eigen::Ref<const RowMatrix>& inputs) const {
  const RowMatrix normalised = normaliser_.Normalise(inputs);
  RowMatrix outputs(inputs.rows(), layers_.back().outputs());
  for (Eigen::Index e = 0; e < inputs.rows(); ++e) {
    FeatureMap values{1, normalised.row(e)};
    for (const QuantisedConvolution& layer : layers_) {
      if (&layer != &layers_.front()) values = Rectified(std::move(values));
      values = layer.Run(values);
    }
    outputs.row(e) = values.cells;
  }
  return outputs;
}

}  // namespace ossa
