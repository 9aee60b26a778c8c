#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "depth/base/perceptron/convolution.h"

namespace ossa {

struct OutputLine;

/// A convolution made ready to run often. Weights and features are rounded to some 12 bits, each
/// output's weights and each map's features by a step of their own, and sums are of whole numbers:
/// the same bits on any processor.
class QuantisedConvolution {
 public:
  QuantisedConvolution() = default;
  /// Precondition: its weights are finite.
  explicit QuantisedConvolution(const Convolution& layer);
  /// What the convolution makes of a map, not rectified. Where features are not finite, nothing is.
  /// Precondition: its inputs are the map's channels, and its stride divides the map's side.
  FeatureMap Run(const FeatureMap& map) const;
  Eigen::Index outputs() const { return bias_.size(); }

 private:
  int size_ = 0, stride_ = 0;
  std::shared_ptr<const std::vector<OutputLine>> lines_;  // of all pairs for the first outputs, ...
  Eigen::RowVectorXf step_;  // of each output: what a weight's 1 is worth
  Eigen::RowVectorXf bias_;
};

}  // namespace ossa
