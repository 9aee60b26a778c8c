#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace ossa::forest {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A layer of a network: outputs = inputs · weight + bias.
struct NetworkLayer {
  std::vector<float> weight;  // input × output, row-major
  std::vector<float> bias;    // one an output
};

/// Examples to learn a network of, a row each.
struct NetworkExamples {
  RowMatrix input;   // normalised: about 0, spread of about 1
  RowMatrix wanted;  // whatever the loss understands
};

/// The gradient, by the outputs of a batch, of the loss that is to fall; `wanted`: their rows.
using LossGradient = std::function<RowMatrix(const RowMatrix& out, const RowMatrix& wanted)>;

struct NetworkOptions {
  std::vector<Eigen::Index> hidden = {512};  // rectified units of each hidden layer
  Eigen::Index outputs = 0;
  int64_t epochs = 12;  // times that every example is seen
  uint64_t seed = 1;
  std::function<void(int64_t step, int64_t steps)> progress;
  std::function<bool()> stop;  // true: end with TrainInterrupted as soon as possible
};

inline constexpr Eigen::Index kNetworkBatch = 128;

/// Learns a network by Adam with dropout (network_trainer_internal.h), in
/// batches of kNetworkBatch; what does not fill a batch waits for the next epoch. The same bytes on
/// every machine and for any number of threads. The weights' lower 16 bits are 0.
std::vector<NetworkLayer> LearnNetwork(const NetworkExamples& examples,
                                       const LossGradient& gradient, const NetworkOptions& options);

}  // namespace ossa::forest
