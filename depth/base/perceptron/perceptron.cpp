#include "depth/base/perceptron/perceptron.h"

namespace ossa {

RowMatrix Perceptron::Normalise(const Eigen::Ref<const RowMatrix>& inputs) const {
  RowMatrix normalised = inputs.rowwise() - input_mean;
  normalised.array().rowwise() *= input_scale.array();
  return normalised.cwiseMin(kMostDeviations).cwiseMax(-kMostDeviations);
}

RowMatrix Perceptron::Run(const Eigen::Ref<const RowMatrix>& inputs) const {
  RowMatrix values = Normalise(inputs);
  for (const PerceptronLayer& layer : layers) {
    if (&layer != &layers.front()) values = values.cwiseMax(0.0F);
    values = Multiply(values, layer.weight);
    values.rowwise() += layer.bias;
  }
  return values;
}

}  // namespace ossa
