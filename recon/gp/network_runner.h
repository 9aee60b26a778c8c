#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "recon/gp/rectified_network.h"

namespace ossa::recon {

/// A network made ready to be run often: what inputs of nought say is added up beforehand, so that
/// only the others cost anything, and so it is with units that are silent. Weights are bytes: they
/// come from afar, and few come sooner.
class NetworkRunner {
 public:
  NetworkRunner() = default;
  /// Precondition: the network has layers.
  explicit NetworkRunner(RectifiedNetwork network);

  /// As RectifiedNetwork::Run of a network whose weights are bytes (BytesOf) but for the order of
  /// sums, of several inputs at a time, a column each; so are the outputs.
  Eigen::MatrixXf Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const;

 private:
  struct Layer {
    std::vector<int8_t> weights;  // input by input, `stride` bytes each
    size_t stride = 0;            // as many as the layer has units, or a few more that say nothing
    Eigen::VectorXf step;         // of each input: a byte's worth
    Eigen::VectorXf at_zero;      // what each unit says when all inputs are nought
  };

  RectifiedNetwork network_;  // without its layers: it knows how inputs are normalised
  Eigen::VectorXf nought_;    // inputs of nought, normalised
  std::vector<Layer> layers_;
  Eigen::Index outputs_ = 0;
};

}  // namespace ossa::recon
