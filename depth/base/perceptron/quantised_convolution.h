#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "depth/base/perceptron/convolution.h"

namespace ossa {

struct OutputLine;

/// A convolution prepared for repeated use. Weights and features are quantised to about 12 bits,
/// with one scale per output and per map; sums are integers: the same bits on any processor.
class QuantisedConvolution {
 public:
  QuantisedConvolution() = default;
  /// Precondition: its weights are finite.
  explicit QuantisedConvolution(const Convolution& layer);
  /// The convolution of a map, before rectification. Not finite if features are not. Precondition:
  /// the layer's inputs are the map's channels, and its stride divides the map's side.
  FeatureMap Run(const FeatureMap& map) const;
  Eigen::Index outputs() const { return bias_.size(); }

 private:
  int size_ = 0, stride_ = 0;
  std::shared_ptr<const std::vector<OutputLine>> lines_;  // all pairs for the first outputs, ...
  Eigen::RowVectorXf step_;                               // weight scale of each output
  Eigen::RowVectorXf bias_;
};

}  // namespace ossa
