#include "depth/base/perceptron/quantised_convolution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/perceptron/round_numbers_internal.h"
#include "depth/base/perceptron/window_sums_internal.h"

namespace ossa {
namespace {

// Maximum quantised feature, by hand, and maximum sum of an output's weights: no sum of products
// reaches 2^31, and both are quantised with similar resolution.
constexpr int kMostFeature = (1 << 12) - 1;
constexpr int kMostWeights = std::numeric_limits<int32_t>::max() / kMostFeature;
constexpr int kMostWeight = std::numeric_limits<int16_t>::max();

// Channels are multiplied in pairs: an odd number is padded with a zero.
size_t PaddedChannels(Eigen::Index channels) { return static_cast<size_t>(channels + 1) / 2 * 2; }

// Weight scale of each output.
Eigen::RowVectorXf ChooseSteps(const RowMatrix& weight) {
  if (weight.rows() == 0) return Eigen::RowVectorXf::Zero(weight.cols());
  // Rounding adds up to half a step per weight.
  const float most = static_cast<float>(kMostWeights) - static_cast<float>(weight.rows());
  const Eigen::RowVectorXf largest = weight.cwiseAbs().colwise().maxCoeff();
  const Eigen::RowVectorXf whole = weight.cwiseAbs().colwise().sum();
  return (largest / static_cast<float>(kMostWeight)).cwiseMax(whole / most);
}

// The largest magnitude; not finite if any feature is not. The bits of non-negative floats have the
// same order as their values.
OSSA_CPU_DISPATCH float FindLargest(const float* numbers, size_t count) {
  int32_t largest = 0;
  for (size_t i = 0; i < count; ++i) {
    const int32_t magnitude =
        std::bit_cast<int32_t>(numbers[i]) & std::numeric_limits<int32_t>::max();
    largest = std::max(largest, magnitude);
  }
  return std::bit_cast<float>(largest);
}

OSSA_CPU_DISPATCH void Scale(const int32_t* sums, const float* step, const float* bias,
                             size_t count, float* out) {
  for (size_t i = 0; i < count; ++i) out[i] = bias[i] + step[i] * static_cast<float>(sums[i]);
}

// A quantised map, padded with zeros by the reach of a kernel.
class RoundedMap {
 public:
  RoundedMap(const FeatureMap& map, int border)
      : channels_(PaddedChannels(map.cells.cols())),
        side_(static_cast<size_t>(map.side) + 2 * static_cast<size_t>(border)),
        numbers_(side_ * side_ * channels_, 0) {
    const float largest = FindLargest(map.cells.data(), static_cast<size_t>(map.cells.size()));
    step_ = largest / static_cast<float>(kMostFeature);
    const bool is_something = step_ > std::numeric_limits<float>::min() && std::isfinite(largest);
    if (!is_something) return;  // all zero, or the scale is not finite
    const auto side = static_cast<size_t>(map.side), given = static_cast<size_t>(map.cells.cols());
    const float times = static_cast<float>(kMostFeature) / largest;
    for (size_t row = 0; row < side; ++row) {
      const float* from = map.cells.data() + row * side * given;
      int16_t* to = At(row + static_cast<size_t>(border), static_cast<size_t>(border));
      if (given == channels_) {
        RoundNumbers(from, times, side * given, to);
        continue;
      }
      for (size_t column = 0; column < side; ++column, from += given, to += channels_) {
        RoundNumbers(from, times, given, to);
      }
    }
  }

  float step() const { return step_; }
  size_t channels() const { return channels_; }
  size_t row_numbers() const { return side_ * channels_; }
  const int16_t* At(size_t row, size_t column) const {
    return numbers_.data() + (row * side_ + column) * channels_;
  }
  /// Whether `columns` columns from `column` on are equal to those `before` to the left.
  bool IsLikeLeft(size_t row, size_t column, size_t columns, size_t before) const {
    return std::memcmp(At(row, column), At(row, column - before),
                       columns * channels_ * sizeof(int16_t)) == 0;
  }

 private:
  int16_t* At(size_t row, size_t column) {
    return numbers_.data() + (row * side_ + column) * channels_;
  }

  size_t channels_, side_;
  std::vector<int16_t> numbers_;
  float step_ = 0.0F;
};

// The distinct windows of a map. Background windows are equal and are evaluated once.
struct DistinctWindows {
  std::vector<const int16_t*> first;
  std::vector<size_t> of_cell;  // window of each output cell

  DistinctWindows(const RoundedMap& map, size_t side, size_t size, size_t stride) {
    first.reserve(side * side);
    of_cell.reserve(side * side);
    for (size_t row = 0; row < side; ++row) {
      for (size_t column = 0; column < side; ++column) {
        const auto is_like_left = [&](size_t down) {
          return map.IsLikeLeft(row * stride + down, column * stride, size, stride);
        };
        bool is_new = column == 0;
        for (size_t down = 0; down < size && !is_new; ++down) is_new = !is_like_left(down);
        if (is_new) first.push_back(map.At(row * stride, column * stride));
        of_cell.push_back(first.size() - 1);
      }
    }
  }
};

}  // namespace

QuantisedConvolution::QuantisedConvolution(const Convolution& layer)
    : size_(layer.size),
      stride_(layer.stride),
      step_(ChooseSteps(layer.weight)),
      bias_(layer.bias) {
  const auto cells = static_cast<size_t>(size_) * static_cast<size_t>(size_);
  const auto inputs = static_cast<size_t>(layer.inputs());
  const auto outputs = static_cast<size_t>(bias_.size());
  const size_t cell_pairs = PaddedChannels(layer.inputs()) / 2;
  const size_t pairs = cells * cell_pairs;
  std::vector<OutputLine> lines(CountLines(bias_.size(), OutputLine::kOutputs) * pairs);
  for (size_t k = 0; k < cells * inputs; ++k) {
    const size_t cell = k / inputs, input = k % inputs;
    for (size_t o = 0; o < outputs; ++o) {
      const float step = step_[static_cast<Eigen::Index>(o)];
      if (!(step > std::numeric_limits<float>::min())) continue;
      const float weight =
          layer.weight(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(o)) / step;
      lines[o / OutputLine::kOutputs * pairs + cell * cell_pairs + input / 2]
          .weights[o % OutputLine::kOutputs][input % 2] = static_cast<int16_t>(std::rint(weight));
    }
  }
  lines_ = std::make_shared<const std::vector<OutputLine>>(std::move(lines));
}

FeatureMap QuantisedConvolution::Run(const FeatureMap& map) const {
  FeatureMap out{map.side / stride_, {}};
  const RoundedMap rounded(map, size_ / 2);
  const auto size = static_cast<size_t>(size_);
  const DistinctWindows distinct(rounded, static_cast<size_t>(out.side), size,
                                 static_cast<size_t>(stride_));
  const Windows windows{distinct.first, size, size * rounded.channels() / 2, rounded.row_numbers()};
  const size_t blocks = CountLines(bias_.size(), OutputLine::kOutputs);
  const size_t padded = blocks * OutputLine::kOutputs;
  std::vector<int32_t> sums(distinct.first.size() * padded);
  for (size_t block = 0; block < blocks; ++block) {
    SumWindows(windows, lines_->data() + block * windows.rows * windows.pairs,
               sums.data() + block * OutputLine::kOutputs, padded);
  }
  out.cells.resize(static_cast<Eigen::Index>(distinct.of_cell.size()), bias_.size());
  const Eigen::RowVectorXf step = rounded.step() * step_;
  for (size_t cell = 0; cell < distinct.of_cell.size(); ++cell) {
    Scale(sums.data() + distinct.of_cell[cell] * padded, step.data(), bias_.data(),
          static_cast<size_t>(bias_.size()), out.cells.row(static_cast<Eigen::Index>(cell)).data());
  }
  return out;
}

}  // namespace ossa
