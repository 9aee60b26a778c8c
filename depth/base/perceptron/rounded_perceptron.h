#pragma once
#include <vector>

#include "depth/base/perceptron/perceptron.h"
#include "depth/base/perceptron/quantised_convolution.h"

namespace ossa {

/// A perceptron prepared for repeated use, one example at a time. Weights and activations are
/// quantised to about 12 bits. QuantisedPerceptron needs half the memory, but its weights must have
/// been trained as bytes. The same bits on any processor.
class RoundedPerceptron {
 public:
  RoundedPerceptron() = default;
  /// Precondition: its weights are finite.
  explicit RoundedPerceptron(const Perceptron& perceptron);

  bool empty() const { return layers_.empty(); }
  /// As Perceptron::Run, except for rounding.
  RowMatrix Run(const Eigen::Ref<const RowMatrix>& inputs) const;

 private:
  Perceptron normaliser_;                     // normalisation only, without layers
  std::vector<QuantisedConvolution> layers_;  // as convolutions of maps of one cell
};

}  // namespace ossa
