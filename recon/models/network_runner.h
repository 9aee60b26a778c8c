#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "recon/models/rectified_network.h"

namespace ossa::recon {

/// The weights of a pair of inputs for as many units as fill a line of the cache: of each unit that
/// of the first input and that of the second.
struct alignas(64) WeightLine {
  static constexpr size_t kUnits = 32;  // bytes of half a cache line
  std::array<std::array<int8_t, 2>, kUnits> weights{};
};

/// A network made ready to be run often. Its weights are bytes: they come from afar, and few come
/// sooner. What they are taken times is rounded to some 15 bits, and sums are of whole numbers: the
/// same on any processor. Two inputs are run side by side: what a weight costs to fetch it costs
/// once.
class NetworkRunner {
 public:
  NetworkRunner() = default;
  /// Precondition: the network has layers, and these have inputs.
  explicit NetworkRunner(const RectifiedNetwork& network);
  /// Of networks that are run one after the other: their weights lie together, in large pages.
  static std::vector<NetworkRunner> Of(const std::vector<const RectifiedNetwork*>& networks);

  /// As RectifiedNetwork::Run of a network whose weights are bytes (BytesOf) but for rounding, of
  /// several inputs at a time, a column each; so are the outputs.
  Eigen::MatrixXf Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const;

 private:
  struct Layer {
    size_t first_line = 0;  // those of all pairs for the first units, then for the next ones
    size_t blocks = 0;      // of units, a line each
    Eigen::VectorXf step;   // of each input: a byte's worth
    Eigen::VectorXf bias;
  };
  template <size_t kColumns>
  void RunColumns(const Eigen::Ref<const Eigen::MatrixXf>& inputs, Eigen::Index first,
                  Eigen::MatrixXf* outputs) const;
  void Add(const RectifiedNetwork& network, std::vector<WeightLine>* lines);

  std::shared_ptr<const std::vector<WeightLine>> lines_;  // of all that are run together
  RectifiedNetwork network_;  // without its layers: it knows how inputs are normalised
  std::vector<Layer> layers_;
};

}  // namespace ossa::recon
