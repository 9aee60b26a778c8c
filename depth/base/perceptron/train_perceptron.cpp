#include "depth/base/perceptron/train_perceptron.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "depth/base/error.h"
#include "depth/base/perceptron/perceptron_trainer.h"
#include "depth/base/random.h"
#include "depth/base/train_interrupted.h"

namespace ossa {
namespace {

constexpr int64_t kWarmUp = 200;  // steps until the learning rate is at its maximum; by hand

RowMatrix ChooseRows(const RowMatrix& all, std::span<const Eigen::Index> chosen) {
  RowMatrix rows(static_cast<Eigen::Index>(chosen.size()), all.cols());
  for (size_t i = 0; i < chosen.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = all.row(chosen[i]);
  }
  return rows;
}

// Linear warm-up, then cosine decay to zero (Loshchilov and Hutter 2017).
float ComputeRate(double highest, int64_t step, int64_t steps) {
  const double done = static_cast<double>(step) / static_cast<double>(steps);
  const double warm = std::min(1.0, static_cast<double>(step + 1) / static_cast<double>(kWarmUp));
  return static_cast<float>(highest * warm * 0.5 * (1.0 + std::cos(std::numbers::pi * done)));
}

// Fits the normalisation, and normalises the inputs in place, row by row, because they may fill
// much of the memory.
void NormaliseInputs(RowMatrix* input, const PerceptronTraining& training, Perceptron* perceptron) {
  const auto count = static_cast<double>(input->rows());
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(input->cols()), square = mean;
  for (const auto& row : input->rowwise()) mean += row.cast<double>();
  mean /= count;
  for (const auto& row : input->rowwise()) square += (row.cast<double>() - mean).cwiseAbs2();
  const Eigen::RowVectorXd deviation = (square / count).cwiseSqrt();
  perceptron->input_mean = mean.cast<float>();
  perceptron->input_scale = (deviation.array() + training.least_deviation).inverse().cast<float>();
  for (auto row : input->rowwise()) {
    row = (row - perceptron->input_mean).cwiseProduct(perceptron->input_scale);
    if (!training.clip_inputs) continue;
    row = row.cwiseMin(Perceptron::kMostDeviations).cwiseMax(-Perceptron::kMostDeviations);
  }
}

std::vector<PerceptronLayer> TrainLayers(const PerceptronExamples& examples,
                                         const LossGradient& gradient,
                                         const PerceptronTraining& training) {
  std::vector<Eigen::Index> widths = {examples.input.cols()};
  widths.insert(widths.end(), training.hidden.begin(), training.hidden.end());
  widths.push_back(training.outputs);
  PerceptronTrainer trainer(widths, {training.decay, training.dropped}, training.seed);
  std::vector<Eigen::Index> order(static_cast<size_t>(examples.input.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  Random random(MixSeed(training.seed, 0x5befe7));
  const auto batches = static_cast<int64_t>(order.size()) / training.batch;
  const int64_t steps = batches * training.epochs;
  for (int64_t step = 0; step < steps; ++step) {
    if (training.stop && training.stop()) throw TrainInterrupted("interrupted while training");
    const int64_t batch = step % batches;
    for (size_t i = order.size(); batch == 0 && i > 1; --i) {
      std::swap(order[i - 1], order[random.Below(static_cast<uint32_t>(i))]);
    }
    const std::span chosen(order.data() + batch * training.batch,
                           static_cast<size_t>(training.batch));
    const RowMatrix& out = trainer.Forward(ChooseRows(examples.input, chosen));
    trainer.Step(gradient(out, ChooseRows(examples.wanted, chosen)),
                 ComputeRate(double{training.rate}, step, steps));
    if (training.progress) training.progress(step + 1, steps);
  }
  return trainer.Layers();
}

}  // namespace

Perceptron TrainPerceptron(PerceptronExamples* examples, const LossGradient& gradient,
                           const PerceptronTraining& training) {
  Perceptron perceptron;
  NormaliseInputs(&examples->input, training, &perceptron);
  perceptron.layers = TrainLayers(*examples, gradient, training);
  return perceptron;
}

LossGradient PointDistanceGradient(float soft) {
  return [soft](const RowMatrix& out, const RowMatrix& wanted) {
    RowMatrix gradient = out - wanted;
    for (Eigen::Index i = 0; i < gradient.rows(); ++i) {
      for (Eigen::Index k = 0; k < gradient.cols(); k += 3) {
        auto error = gradient.block<1, 3>(i, k);
        if (!error.allFinite()) {
          error.setZero();
        } else {
          error /= std::sqrt(error.squaredNorm() + soft * soft);
        }
      }
    }
    return RowMatrix(gradient / static_cast<float>(gradient.rows()));
  };
}

LossGradient AbsoluteErrorGradient(float soft) {
  return [soft](const RowMatrix& out, const RowMatrix& wanted) {
    const auto error = (out - wanted).array().eval();
    const auto rows = static_cast<float>(out.rows());
    return RowMatrix(error / (rows * (error.square() + soft * soft).sqrt()));
  };
}

}  // namespace ossa
