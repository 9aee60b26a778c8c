#include "depth/base/perceptron/perceptron_trainer.h"

#include <bit>
#include <cmath>

#include "depth/base/cpu_dispatch.h"

namespace ossa {
namespace {

constexpr float kMeanKept = 0.9F;  // no unit: Adam's beta 1 and 2 and epsilon (Kingma and Ba 2015)
constexpr float kSquareKept = 0.999F;     // no unit; Kingma and Ba 2015
constexpr float kLeastRoot = 1e-8F;       // no unit; Kingma and Ba 2015
constexpr float kLastLayerScale = 0.05F;  // a factor, by hand: initial outputs are small

// He et al. 2015: keeps the variance of activations between layers.
RowMatrix RandomWeights(Eigen::Index inputs, Eigen::Index outputs, Random* random) {
  RowMatrix weight(inputs, outputs);
  const double bound = std::sqrt(6.0 / static_cast<double>(inputs));
  for (Eigen::Index i = 0; i < weight.size(); ++i) {
    weight.data()[i] = static_cast<float>(bound * (2.0 * random->Unit() - 1.0));
  }
  return weight;
}

struct Running {
  float *value, *mean, *square;
};

// In a single pass: the parameters exceed the L1 and L2 caches.
OSSA_CPU_DISPATCH void DescendAll(const Running& of, const float* gradient, Eigen::Index count,
                                  float rate, float square_scale) {
  float* __restrict value = of.value;
  float* __restrict mean = of.mean;
  float* __restrict square = of.square;
  for (Eigen::Index i = 0; i < count; ++i) {
    const float slope = gradient[i];
    mean[i] = kMeanKept * mean[i] + (1.0F - kMeanKept) * slope;
    square[i] = kSquareKept * square[i] + (1.0F - kSquareKept) * (slope * slope);
    value[i] -= rate * mean[i] / (std::sqrt(square_scale * square[i]) + kLeastRoot);
  }
}

// Rounded to the upper half of a float's bits: the rest is below the accuracy of training, and
// would cost two bytes each in the file.
float Rounded(float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  return std::bit_cast<float>((bits + 0x8000U) & 0xffff0000U);
}

RowMatrix Rounded(const RowMatrix& values) {
  return values.unaryExpr([](float value) { return Rounded(value); });
}

}  // namespace

PerceptronTrainer::Learned::Learned(RowMatrix start)
    : value(std::move(start)),
      mean(RowMatrix::Zero(value.rows(), value.cols())),
      square(RowMatrix::Zero(value.rows(), value.cols())) {}

void PerceptronTrainer::Learned::Descend(const RowMatrix& gradient, float rate, int step) {
  const auto steps = static_cast<double>(step);
  const auto mean_scale = static_cast<float>(1.0 / (1.0 - std::pow(double{kMeanKept}, steps)));
  const auto square_scale = static_cast<float>(1.0 / (1.0 - std::pow(double{kSquareKept}, steps)));
  DescendAll({value.data(), mean.data(), square.data()}, gradient.data(), value.size(),
             rate * mean_scale, square_scale);
}

PerceptronTrainer::PerceptronTrainer(const std::vector<Eigen::Index>& widths,
                                     Regularisation regularisation, uint64_t seed)
    : regularisation_(regularisation), random_(seed) {
  for (size_t l = 0; l + 1 < widths.size(); ++l) {
    weight_.emplace_back(RandomWeights(widths[l], widths[l + 1], &random_));
    bias_.emplace_back(RowMatrix::Zero(1, widths[l + 1]));
  }
  weight_.back().value *= kLastLayerScale;
}

void PerceptronTrainer::DropUnits(RowMatrix* activation) {
  if (regularisation_.dropped == 0.0F) return;
  const auto bound = static_cast<uint64_t>(static_cast<double>(regularisation_.dropped) * 0x1p64);
  for (Eigen::Index i = 0; i < activation->size(); ++i) {
    float& value = activation->data()[i];
    value = random_.Bits() < bound ? 0.0F : value / (1.0F - regularisation_.dropped);
  }
}

const RowMatrix& PerceptronTrainer::Forward(RowMatrix batch) {
  activation_ = {std::move(batch)};
  for (size_t l = 0; l < weight_.size(); ++l) {
    RowMatrix out = Multiply(activation_.back(), weight_[l].value);
    out.rowwise() += bias_[l].value.row(0);
    if (l + 1 < weight_.size()) {
      out = out.cwiseMax(0.0F);
      DropUnits(&out);
    }
    activation_.push_back(std::move(out));
  }
  return activation_.back();
}

void PerceptronTrainer::Step(RowMatrix gradient, float rate) {
  ++step_;
  for (size_t l = weight_.size(); l-- > 0;) {
    const RowMatrix& input = activation_[l];
    const RowMatrix by_weight = Multiply(input.transpose(), gradient);
    const RowMatrix by_bias = gradient.colwise().sum();
    if (l > 0) {  // through the rectifier and dropout
      gradient = Multiply(gradient, weight_[l].value.transpose());
      gradient = (input.array() > 0.0F).select(gradient, 0.0F) / (1.0F - regularisation_.dropped);
    }
    weight_[l].value *= 1.0F - rate * regularisation_.decay;
    weight_[l].Descend(by_weight, rate, step_);
    bias_[l].Descend(by_bias, rate, step_);
  }
}

std::vector<PerceptronLayer> PerceptronTrainer::Layers() const {
  std::vector<PerceptronLayer> layers;
  for (size_t l = 0; l < weight_.size(); ++l) {
    layers.push_back({Rounded(weight_[l].value), Rounded(bias_[l].value).row(0)});
  }
  return layers;
}

}  // namespace ossa
