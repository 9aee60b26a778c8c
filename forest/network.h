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

inline constexpr Eigen::Index kNetworkBatch = 128;

/// How a network is trained by gradient descent.
struct NetworkOptions {
  std::vector<Eigen::Index> hidden = {512};  // rectified units of each hidden layer
  Eigen::Index outputs = 0;
  int64_t epochs = 12;  // times that every example is seen
  Eigen::Index batch = kNetworkBatch;
  float rate = 1e-3F;    // of Adam, at its highest
  float decay = 0.02F;   // of weights, a unit of the rate
  float dropped = 0.1F;  // share of hidden units a step; for a forest 0.2 and none are worse
  uint64_t seed = 1;
  std::function<void(int64_t step, int64_t steps)> progress;
  std::function<bool()> stop;  // true: end with TrainInterrupted as soon as possible
};

/// Learns a network by Adam with dropout (network_trainer_internal.h), in batches; what does not
/// fill a batch waits for the next epoch. The same bytes on every machine and for any number of
/// threads. The weights' lower 16 bits are 0.
std::vector<NetworkLayer> LearnNetwork(const NetworkExamples& examples,
                                       const LossGradient& gradient, const NetworkOptions& options);

}  // namespace ossa::forest
