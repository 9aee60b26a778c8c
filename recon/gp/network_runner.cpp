#include "recon/gp/network_runner.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "depth/clones.h"

namespace ossa::recon {
namespace {

constexpr size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using WordLanes = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

// The weights of so many units lie in as many words as there are lanes: the word of a lane has in
// its lowest byte the unit of that lane, in the next the one kLanes units on. Thus bytes become
// numbers without leaving their lane.
constexpr size_t kInWords = kLanes * sizeof(int32_t);

// An input that says something: its column of the weights, and by how much to take it.
struct Term {
  const int8_t* column = nullptr;
  float factor = 0.0F;
};

constexpr size_t kAhead = 12;  // terms whose weights are fetched while others are added

// kGroups times kInWords sums, held in registers while all terms go by.
template <size_t kGroups>
[[gnu::always_inline]] inline void AddTile(const Term* terms, size_t count, size_t row,
                                           float* sums) {
  constexpr int32_t kHighest = static_cast<int32_t>(0xff000000U);
  Lanes sum[kGroups][sizeof(int32_t)];
  std::memcpy(sum, sums + row, sizeof(sum));
  for (size_t t = 0; t < count; ++t) {
    __builtin_prefetch(terms[t + kAhead].column + row);
    const float factor = terms[t].factor * 0x1p-24F;
    for (size_t group = 0; group < kGroups; ++group) {
      WordLanes words;
      std::memcpy(&words, terms[t].column + row + group * kInWords, sizeof(words));
      sum[group][0] += factor * __builtin_convertvector(words << 24, Lanes);
      sum[group][1] += factor * __builtin_convertvector((words << 16) & kHighest, Lanes);
      sum[group][2] += factor * __builtin_convertvector((words << 8) & kHighest, Lanes);
      sum[group][3] += factor * __builtin_convertvector(words & kHighest, Lanes);
    }
  }
  std::memcpy(sums + row, sum, sizeof(sum));
}

// `rows`: a multiple of kInWords. After the terms there are kAhead more, of any column.
OSSA_CLONES void AddTerms(const Term* terms, size_t count, size_t rows, float* sums) {
  size_t row = 0;
  for (; row + 2 * kInWords <= rows; row += 2 * kInWords) AddTile<2>(terms, count, row, sums);
  for (; row < rows; row += kInWords) AddTile<1>(terms, count, row, sums);
}

size_t Padded(Eigen::Index rows) {
  return (static_cast<size_t>(rows) + kInWords - 1) / kInWords * kInWords;
}

// Where among its input's bytes the weight of a unit lies.
size_t PlaceOf(size_t unit) {
  const size_t in_group = unit % kInWords;
  return unit - in_group + in_group % kLanes * sizeof(int32_t) + in_group / kLanes;
}

// The terms of the factors that are not nought, and kAhead more. Without a branch: which ones are
// not, nobody foresees.
size_t TermsOf(const Eigen::VectorXf& factors, const int8_t* weights, size_t stride,
               const Eigen::VectorXf& step, std::vector<Term>& terms) {
  const auto inputs = static_cast<size_t>(step.size());  // factors may be padded
  terms.resize(inputs + kAhead);
  size_t count = 0;
  for (size_t i = 0; i < inputs; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    terms[count] = {weights + i * stride, factors[at] * step[at]};
    count += factors[at] != 0.0F ? 1 : 0;
  }
  std::fill_n(terms.begin() + static_cast<std::ptrdiff_t>(count), kAhead, Term{weights, 0.0F});
  return count;
}

}  // namespace

NetworkRunner::NetworkRunner(RectifiedNetwork network) : network_(std::move(network)) {
  nought_ = network_.Normalised(Eigen::VectorXf::Zero(network_.input_mean.size()));
  for (const RectifiedNetwork::Layer& layer : std::exchange(network_.layers, {})) {
    const WeightBytes bytes = BytesOf(layer.weight);
    Layer& ready = layers_.emplace_back();
    ready.stride = Padded(layer.weight.rows());
    ready.at_zero = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(ready.stride));
    ready.at_zero.head(layer.bias.size()) = layer.bias;
    if (layers_.size() == 1) ready.at_zero.head(layer.bias.size()) += layer.weight * nought_;
    ready.step = bytes.step;
    outputs_ = layer.bias.size();
    ready.weights.assign(ready.stride * static_cast<size_t>(layer.weight.cols()), 0);
    for (Eigen::Index c = 0; c < layer.weight.cols(); ++c) {
      int8_t* column = ready.weights.data() + static_cast<size_t>(c) * ready.stride;
      for (Eigen::Index r = 0; r < layer.weight.rows(); ++r) {
        column[PlaceOf(static_cast<size_t>(r))] = bytes.of(r, c);
      }
    }
  }
}

Eigen::MatrixXf NetworkRunner::Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const {
  Eigen::MatrixXf outputs(outputs_, inputs.cols());
  std::vector<Term> terms;
  for (Eigen::Index c = 0; c < inputs.cols(); ++c) {
    Eigen::VectorXf value = network_.Normalised(inputs.col(c)) - nought_;
    for (const Layer& layer : layers_) {
      const size_t count = TermsOf(value, layer.weights.data(), layer.stride, layer.step, terms);
      Eigen::VectorXf sums = layer.at_zero;
      AddTerms(terms.data(), count, layer.stride, sums.data());
      value = std::move(sums);
      if (&layer != &layers_.back()) value = value.cwiseMax(0.0F).eval();
    }
    outputs.col(c) = value.head(outputs_);
  }
  return outputs;
}

}  // namespace ossa::recon
