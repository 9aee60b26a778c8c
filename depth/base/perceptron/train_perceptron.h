#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "depth/base/perceptron/perceptron.h"

namespace ossa {

/// Training examples of a perceptron, one per row.
struct PerceptronExamples {
  RowMatrix input;   // not normalised
  RowMatrix wanted;  // targets, as the loss expects them
};

/// The gradient of the loss with respect to a batch's outputs; `wanted`: their targets.
using LossGradient = std::function<RowMatrix(const RowMatrix& out, const RowMatrix& wanted)>;

inline constexpr Eigen::Index kPerceptronBatch = 128;

/// How a perceptron is trained by gradient descent.
struct PerceptronTraining {
  std::vector<Eigen::Index> hidden = {512};  // rectified units of each hidden layer
  Eigen::Index outputs = 0;
  int64_t epochs = 12;  // passes over the examples
  Eigen::Index batch = kPerceptronBatch;
  float rate = 1e-3F;   // Adam's maximum learning rate; its authors' default (Kingma and Ba 2015)
  float decay = 0.02F;  // weight decay per unit of the learning rate; chosen on validation subjects
  float dropped = 0.1F;           // dropout, share of hidden units; chosen on validation subjects
  double least_deviation = 1e-3;  // added to each input's standard deviation, in its unit; by hand
  bool clip_inputs = false;       // clip outliers in training, as Perceptron::Normalise does
  uint64_t seed = 1;
  std::function<void(int64_t step, int64_t steps)> progress;
  std::function<bool()> stop;  // true: stop with TrainInterrupted
};

/// Trains a perceptron by Adam with dropout (PerceptronTrainer), in batches; an incomplete batch is
/// left for the next epoch. The inputs are normalised in place. The same bytes on every machine and
/// for any number of threads. The lower 16 bits of the weights are 0.
Perceptron TrainPerceptron(PerceptronExamples* examples, const LossGradient& gradient,
                           const PerceptronTraining& training);

/// Gradient of the mean distance between output and target points of three numbers each, smooth
/// below `soft` (Charbonnier's loss, sqrt(e² + soft²)). Non-finite targets are ignored.
LossGradient PointDistanceGradient(float soft);

/// Gradient of the mean absolute error of the outputs, smooth below `soft` in the same way.
LossGradient AbsoluteErrorGradient(float soft);

}  // namespace ossa
