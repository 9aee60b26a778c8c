#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "recon/gp/rectified_network.h"

namespace ossa::recon {

/// The weights of one input for as many units as a line of the cache holds.
struct alignas(64) WeightLine {
  std::array<int8_t, 64> weights;
};

/// A network made ready to be run often: what inputs of nought say is added up beforehand, so that
/// only the others cost anything, and so it is with units that are silent. Weights are bytes: they
/// come from afar, and few come sooner. Two inputs are run side by side: what a weight costs to
/// fetch it costs once.
class NetworkRunner {
 public:
  NetworkRunner() = default;
  /// Precondition: the network has layers.
  explicit NetworkRunner(const RectifiedNetwork& network);
  /// Of networks that are run one after the other: their weights lie together, in large pages.
  static std::vector<NetworkRunner> Of(const std::vector<const RectifiedNetwork*>& networks);

  /// As RectifiedNetwork::Run of a network whose weights are bytes (BytesOf) but for the order of
  /// sums, of several inputs at a time, a column each; so are the outputs.
  Eigen::MatrixXf Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const;

 private:
  struct Layer {
    size_t first_line = 0;    // those of all inputs for the first units, then for the next ones
    Eigen::VectorXf step;     // of each input: a byte's worth
    Eigen::VectorXf at_zero;  // what each unit says when all inputs are nought; fills the lines
  };
  template <size_t kColumns>
  void RunColumns(const Eigen::Ref<const Eigen::MatrixXf>& inputs, Eigen::Index first,
                  Eigen::MatrixXf* outputs) const;
  static size_t LinesOf(const RectifiedNetwork& network);
  void Add(const RectifiedNetwork& network, std::vector<WeightLine>* lines);

  std::shared_ptr<const std::vector<WeightLine>> lines_;  // of all that are run together
  RectifiedNetwork network_;  // without its layers: it knows how inputs are normalised
  Eigen::VectorXf nought_;    // inputs of nought, normalised
  std::vector<Layer> layers_;
  Eigen::Index outputs_ = 0;
};

}  // namespace ossa::recon
