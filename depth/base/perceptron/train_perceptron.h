#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "depth/base/perceptron/perceptron.h"

namespace ossa {

/// Examples to train a perceptron on, a row each.
struct PerceptronExamples {
  RowMatrix input;   // as it comes
  RowMatrix wanted;  // whatever the loss understands
};

/// The gradient, by the outputs of a batch, of the loss that is to fall; `wanted`: their rows.
using LossGradient = std::function<RowMatrix(const RowMatrix& out, const RowMatrix& wanted)>;

inline constexpr Eigen::Index kPerceptronBatch = 128;

/// How a perceptron is trained by gradient descent.
struct PerceptronTraining {
  std::vector<Eigen::Index> hidden = {512};  // rectified units of each hidden layer
  Eigen::Index outputs = 0;
  int64_t epochs = 12;  // times that every example is seen
  Eigen::Index batch = kPerceptronBatch;
  float rate = 1e-3F;   // of Adam, at its highest; its authors' (Kingma and Ba 2015)
  float decay = 0.02F;  // of weights, a unit of the rate; chosen on validation subjects
  /// Share of hidden units a step; chosen on validation subjects: for a forest's refinement 0.2 and
  /// none are worse.
  float dropped = 0.1F;
  double least_deviation = 1e-3;  // added to each input's standard deviation, its unit; by hand
  bool clip_inputs = false;  // cut outliers off in training, too, as Perceptron::Normalise does
  uint64_t seed = 1;
  std::function<void(int64_t step, int64_t steps)> progress;
  std::function<bool()> stop;  // true: end with TrainInterrupted soon
};

/// Trains a perceptron by Adam with dropout (PerceptronTrainer), in batches; what does not fill a
/// batch waits for the next epoch. The examples' inputs are normalised in place. The same bytes on
/// every machine and for any number of threads. The weights' lower 16 bits are 0.
Perceptron TrainPerceptron(PerceptronExamples* examples, const LossGradient& gradient,
                           const PerceptronTraining& training);

/// The gradient of the mean distance between outputs and wanted points, three numbers each; smooth
/// below `soft` (Charbonnier's loss, sqrt(e² + soft²)). Points that are not finite do not count.
LossGradient PointDistanceGradient(float soft);

/// The gradient of the mean absolute error of the outputs, smooth below `soft` in the same way.
LossGradient AbsoluteErrorGradient(float soft);

}  // namespace ossa
