#pragma once
#include <cstdint>
#include <vector>

#include "recon/gp/rectified_network.h"

namespace ossa::recon {

/// A network made ready to be run often: what inputs of nought say is added up beforehand, so that
/// only the others cost anything.
class NetworkRunner {
 public:
  NetworkRunner() = default;
  /// Precondition: the network has layers.
  explicit NetworkRunner(RectifiedNetwork network);

  /// As RectifiedNetwork::Run of a network that was read from a file but for the order of sums, of
  /// several inputs at a time, a column each; so are the outputs.
  Eigen::MatrixXf Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const;

 private:
  RectifiedNetwork network_;       // without the first layer's weights
  std::vector<uint16_t> weights_;  // those, input by input: they come from afar, halves do sooner
  Eigen::VectorXf at_zero_;        // inputs of nought, normalised
  Eigen::VectorXf first_layer_;    // what they make the first layer say
};

}  // namespace ossa::recon
