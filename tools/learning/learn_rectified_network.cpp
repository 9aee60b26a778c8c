#include "tools/learning/learn_rectified_network.h"

#include <cmath>

namespace ossa::tools {
namespace {

// Row by row, as they lie: the inputs may fill much of the memory.
void Normalise(forest::RowMatrix* input, recon::RectifiedNetwork* network) {
  constexpr double kLeastDeviation = 1e-3;
  const auto count = static_cast<double>(input->rows());
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(input->cols()), square = mean;
  for (const auto& row : input->rowwise()) mean += row.cast<double>();
  mean /= count;
  for (const auto& row : input->rowwise()) square += (row.cast<double>() - mean).cwiseAbs2();
  const Eigen::RowVectorXd deviation = (square / count).cwiseSqrt();
  network->input_mean = mean.cast<float>();
  network->input_scale = (deviation.array() + kLeastDeviation).inverse().cast<float>();
  for (auto row : input->rowwise()) {
    row = (row - network->input_mean.transpose()).cwiseProduct(network->input_scale.transpose());
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

forest::LossGradient GradientOfNumbers(float soft) {
  return [soft](const forest::RowMatrix& out, const forest::RowMatrix& wanted) {
    const auto error = (out - wanted).array().eval();
    const auto rows = static_cast<float>(out.rows());
    return forest::RowMatrix(error / (rows * (error.square() + soft * soft).sqrt()));
  };
}

}  // namespace ossa::tools
