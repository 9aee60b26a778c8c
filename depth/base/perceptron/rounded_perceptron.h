#pragma once
#include <vector>

#include "depth/base/perceptron/perceptron.h"
#include "depth/base/perceptron/quantised_convolution.h"

namespace ossa {

/// A perceptron made ready to run often, an example at a time. Its weights and activations are
/// rounded to some 12 bits, where QuantisedPerceptron, which needs half the memory, has weights
/// that were learned to be bytes. The same bits on any processor.
class RoundedPerceptron {
 public:
  RoundedPerceptron() = default;
  /// Precondition: its weights are finite.
  explicit RoundedPerceptron(const Perceptron& perceptron);

  bool empty() const { return layers_.empty(); }
  /// As Perceptron::Run, but for rounding.
  RowMatrix Run(const Eigen::Ref<const RowMatrix>& inputs) const;

 private:
  Perceptron normaliser_;                     // has no layers
  std::vector<QuantisedConvolution> layers_;  // of maps of one cell
};

}  // namespace ossa
