#pragma once
#include <cstdint>
#include <vector>

#include "recon/gp/rectified_network.h"

namespace ossa::recon {

/// A network made ready to be run often: what inputs of nought say is added up beforehand, so that
/// only the others cost anything, and so it is with units that are silent.
class NetworkRunner {
 public:
  NetworkRunner() = default;
  /// Precondition: the network has layers.
  explicit NetworkRunner(RectifiedNetwork network);

  /// As RectifiedNetwork::Run of a network that was read from a file but for the order of sums, of
  /// several inputs at a time, a column each; so are the outputs.
  Eigen::MatrixXf Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const;

 private:
  struct Layer {
    std::vector<uint16_t> weights;  // input by input: they come from afar, halves do sooner
    Eigen::VectorXf at_zero;        // what it says when all its inputs are nought
  };

  RectifiedNetwork network_;  // without its layers: it knows how inputs are normalised
  Eigen::VectorXf nought_;    // inputs of nought, normalised
  std::vector<Layer> layers_;
};

}  // namespace ossa::recon
