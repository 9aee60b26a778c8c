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

constexpr size_t kAhead = 24;  // terms whose weights are fetched while others are added

// Where among the weights of a line that of a unit lies.
size_t PlaceOf(size_t unit) {
  const size_t in_group = unit % kInWords;
  return unit - in_group + in_group % kLanes * sizeof(int32_t) + in_group / kLanes;
}

}  // namespace

// An input that says something, and by how much to take its weights.
struct NetworkRunner::Term {
  uint32_t input = 0;
  float factor = 0.0F;
};

// The terms of the factors that are not nought, and kAhead more. Without a branch: which ones are
// not, nobody foresees.
size_t NetworkRunner::TermsOf(const Eigen::VectorXf& factors, const Layer& layer,
                              std::vector<Term>& terms) {
  const auto inputs = static_cast<size_t>(layer.step.size());  // factors may be padded
  terms.resize(inputs + kAhead);
  size_t count = 0;
  for (size_t i = 0; i < inputs; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    terms[count] = {static_cast<uint32_t>(i), factors[at] * layer.step[at]};
    count += factors[at] != 0.0F ? 1 : 0;
  }
  std::fill_n(terms.begin() + static_cast<std::ptrdiff_t>(count), kAhead, Term{});
  return count;
}

// To the sums of the units of a line, which registers hold while all terms go by.
OSSA_CLONES void NetworkRunner::AddTerms(const std::vector<Term>& terms, size_t count,
                                         const Line* lines, float* sums) {
  constexpr size_t kGroups = sizeof(Line) / kInWords;
  constexpr int32_t kHighest = static_cast<int32_t>(0xff000000U);
  Lanes sum[kGroups][sizeof(int32_t)];
  std::memcpy(sum, sums, sizeof(sum));
  const Term* term = terms.data();
  for (const Term* const end = term + count; term < end; ++term) {
    __builtin_prefetch(lines + term[kAhead].input);
    const float factor = term->factor * 0x1p-24F;
    for (size_t group = 0; group < kGroups; ++group) {
      WordLanes words;
      std::memcpy(&words, lines[term->input].weights.data() + group * kInWords, sizeof(words));
      sum[group][0] += factor * __builtin_convertvector(words << 24, Lanes);
      sum[group][1] += factor * __builtin_convertvector((words << 16) & kHighest, Lanes);
      sum[group][2] += factor * __builtin_convertvector((words << 8) & kHighest, Lanes);
      sum[group][3] += factor * __builtin_convertvector(words & kHighest, Lanes);
    }
  }
  std::memcpy(sums, sum, sizeof(sum));
}

NetworkRunner::NetworkRunner(RectifiedNetwork network) : network_(std::move(network)) {
  nought_ = network_.Normalised(Eigen::VectorXf::Zero(network_.input_mean.size()));
  for (const RectifiedNetwork::Layer& layer : std::exchange(network_.layers, {})) {
    const auto units = static_cast<size_t>(layer.weight.rows());
    const auto inputs = static_cast<size_t>(layer.weight.cols());
    const size_t blocks = (units + sizeof(Line) - 1) / sizeof(Line);
    const WeightBytes bytes = BytesOf(layer.weight);
    Layer& ready = layers_.emplace_back();
    ready.step = bytes.step;
    ready.at_zero = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(blocks * sizeof(Line)));
    ready.at_zero.head(layer.bias.size()) = layer.bias;
    if (layers_.size() == 1) ready.at_zero.head(layer.bias.size()) += layer.weight * nought_;
    ready.lines.resize(blocks * inputs, Line{});
    for (size_t i = 0; i < inputs; ++i) {
      for (size_t unit = 0; unit < units; ++unit) {
        Line& line = ready.lines[unit / sizeof(Line) * inputs + i];
        line.weights[PlaceOf(unit % sizeof(Line))] =
            bytes.of(static_cast<Eigen::Index>(unit), static_cast<Eigen::Index>(i));
      }
    }
    outputs_ = layer.bias.size();
  }
}

Eigen::MatrixXf NetworkRunner::Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const {
  Eigen::MatrixXf outputs(outputs_, inputs.cols());
  std::vector<Term> terms;
  for (Eigen::Index c = 0; c < inputs.cols(); ++c) {
    Eigen::VectorXf value = network_.Normalised(inputs.col(c)) - nought_;
    for (const Layer& layer : layers_) {
      if (&layer != &layers_.front()) value = value.cwiseMax(0.0F).eval();
      const size_t count = TermsOf(value, layer, terms);
      value = layer.at_zero;
      const Line* lines = layer.lines.data();
      for (Eigen::Index unit = 0; unit < value.size(); unit += sizeof(Line)) {
        AddTerms(terms, count, lines, value.data() + unit);
        lines += layer.step.size();
      }
    }
    outputs.col(c) = value.head(outputs_);
  }
  return outputs;
}

}  // namespace ossa::recon
