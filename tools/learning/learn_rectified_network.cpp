#include "tools/learning/learn_rectified_network.h"

#include <cmath>

namespace ossa::tools {
namespace {

// Column by column: the inputs may fill much of the memory.
void Normalise(forest::RowMatrix* input, recon::RectifiedNetwork* network) {
  constexpr double kLeastDeviation = 1e-3;
  network->input_mean.resize(input->cols());
  network->input_scale.resize(input->cols());
  for (Eigen::Index i = 0; i < input->cols(); ++i) {
    const Eigen::VectorXd column = input->col(i).cast<double>();
    const double mean = column.mean();
    const double deviation = std::sqrt((column.array() - mean).square().mean());
    network->input_mean[i] = static_cast<float>(mean);
    network->input_scale[i] = static_cast<float>(1.0 / (deviation + kLeastDeviation));
    input->col(i) = (input->col(i).array() - network->input_mean[i]) * network->input_scale[i];
  }
}

Eigen::MatrixXf Transposed(const forest::NetworkLayer& layer, Eigen::Index inputs) {
  const auto outputs = static_cast<Eigen::Index>(layer.bias.size());
  return Eigen::Map<const forest::RowMatrix>(layer.weight.data(), inputs, outputs).transpose();
}

Eigen::VectorXf BiasOf(const forest::NetworkLayer& layer) {
  return Eigen::Map<const Eigen::VectorXf>(layer.bias.data(),
                                           static_cast<Eigen::Index>(layer.bias.size()));
}

}  // namespace

recon::RectifiedNetwork LearnRectifiedNetwork(forest::NetworkExamples* examples,
                                              const forest::LossGradient& gradient,
                                              const forest::NetworkOptions& options) {
  recon::RectifiedNetwork network;
  Normalise(&examples->input, &network);
  const auto layers = forest::LearnNetwork(*examples, gradient, options);
  Eigen::Index inputs = examples->input.cols();
  for (const forest::NetworkLayer& layer : layers) {
    network.layers.push_back({Transposed(layer, inputs), BiasOf(layer)});
    inputs = static_cast<Eigen::Index>(layer.bias.size());
  }
  return network;
}

forest::LossGradient GradientOfLengths(float soft) {
  return [soft](const forest::RowMatrix& out, const forest::RowMatrix& wanted) {
    forest::RowMatrix gradient = out - wanted;
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
    return forest::RowMatrix(gradient / static_cast<float>(gradient.rows()));
  };
}

}  // namespace ossa::tools
