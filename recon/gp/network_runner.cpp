#include "recon/gp/network_runner.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "depth/clones.h"
#include "depth/large_pages.h"

namespace ossa::recon {
namespace {

constexpr size_t kLanes = 8;  // GCC makes poor code of more than a register holds
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using WordLanes = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

// The weights of so many units lie in as many words as there are lanes: the word of a lane has in
// its lowest byte the unit of that lane, in the next the one kLanes units on. Thus bytes become
// numbers without leaving their lane.
constexpr size_t kInWords = kLanes * sizeof(int32_t);

// Where among the weights of a line that of a unit lies.
size_t PlaceOf(size_t unit) {
  const size_t in_group = unit % kInWords;
  return unit - in_group + in_group % kLanes * sizeof(int32_t) + in_group / kLanes;
}

constexpr size_t kAhead = 24;  // terms whose weights are fetched while others are added

// How often a line is filled by the weights of one input.
size_t BlocksOf(const RectifiedNetwork::Layer& layer, size_t units_a_line) {
  return (static_cast<size_t>(layer.weight.rows()) + units_a_line - 1) / units_a_line;
}

// An input that says something, and by how much to take its weights in each column.
template <size_t kColumns>
struct Term {
  uint32_t input = 0;
  std::array<float, kColumns> factor{};
};

// The terms whose factors are not nought in all columns. Without a branch: which ones are not,
// nobody foresees. After them come the first ones again, whose weights for the next units are
// wanted next.
template <size_t kColumns>
size_t TermsOf(const std::array<Eigen::VectorXf, kColumns>& factors, const Eigen::VectorXf& step,
               std::vector<Term<kColumns>>& terms) {
  const auto inputs = static_cast<size_t>(step.size());  // factors may be padded
  terms.resize(inputs + kAhead);
  size_t count = 0;
  for (size_t i = 0; i < inputs; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    Term<kColumns>& term = terms[count];
    term.input = static_cast<uint32_t>(i);
    uint32_t some = 0;
    for (size_t c = 0; c < kColumns; ++c) {
      term.factor[c] = factors[c][at] * step[at];
      some |= std::bit_cast<uint32_t>(factors[c][at]) << 1U;  // nought of any sign
    }
    count += some != 0 ? 1 : 0;
  }
  for (size_t i = 0; i < kAhead; ++i) terms[count + i] = i < count ? terms[i] : Term<kColumns>{};
  return count;
}

// To the sums of the units of a line, as many at a time as registers hold sums of while all terms
// go by: the fewer, the more columns a weight is taken for once it has become a number.
template <size_t kColumns>
[[gnu::always_inline]] inline void AddTerms(const std::vector<Term<kColumns>>& terms, size_t count,
                                            const WeightLine* lines, const WeightLine* next_lines,
                                            const std::array<float*, kColumns>& sums) {
  constexpr size_t kGroups = sizeof(WeightLine) / kInWords;
  constexpr size_t kAtOnce = kGroups / kColumns;
  constexpr int32_t kHighest = static_cast<int32_t>(0xff000000U);
  const Term<kColumns>* const end = terms.data() + count;
  const Term<kColumns>* const last_lap = end - std::min(count, kAhead);
  for (size_t first = 0; first < kGroups; first += kAtOnce) {
    Lanes sum[kColumns][kAtOnce][sizeof(int32_t)];
    for (size_t c = 0; c < kColumns; ++c) {
      std::memcpy(sum[c], sums[c] + first * kInWords, sizeof(sum[c]));
    }
    for (const Term<kColumns>* term = terms.data(); term < end; ++term) {
      if (first == 0) {
        __builtin_prefetch((term < last_lap ? lines : next_lines) + term[kAhead].input);
      }
      const int8_t* const weights = lines[term->input].weights.data() + first * kInWords;
      for (size_t group = 0; group < kAtOnce; ++group) {
        WordLanes words;
        std::memcpy(&words, weights + group * kInWords, sizeof(words));
        const Lanes weight[sizeof(int32_t)] = {
            __builtin_convertvector(words << 24, Lanes),
            __builtin_convertvector((words << 16) & kHighest, Lanes),
            __builtin_convertvector((words << 8) & kHighest, Lanes),
            __builtin_convertvector(words & kHighest, Lanes)};
        for (size_t c = 0; c < kColumns; ++c) {
          const float factor = term->factor[c] * 0x1p-24F;
          for (size_t i = 0; i < sizeof(int32_t); ++i) sum[c][group][i] += factor * weight[i];
        }
      }
    }
    for (size_t c = 0; c < kColumns; ++c) {
      std::memcpy(sums[c] + first * kInWords, sum[c], sizeof(sum[c]));
    }
  }
}

OSSA_CLONES_FMA void AddToOne(const std::vector<Term<1>>& terms, size_t count,
                              const WeightLine* lines, const WeightLine* next_lines,
                              const std::array<float*, 1>& sums) {
  AddTerms<1>(terms, count, lines, next_lines, sums);
}

OSSA_CLONES_FMA void AddToTwo(const std::vector<Term<2>>& terms, size_t count,
                              const WeightLine* lines, const WeightLine* next_lines,
                              const std::array<float*, 2>& sums) {
  AddTerms<2>(terms, count, lines, next_lines, sums);
}

}  // namespace

size_t NetworkRunner::LinesOf(const RectifiedNetwork& network) {
  size_t lines = 0;
  for (const RectifiedNetwork::Layer& layer : network.layers) {
    lines += BlocksOf(layer, sizeof(WeightLine)) * static_cast<size_t>(layer.weight.cols());
  }
  return lines;
}

NetworkRunner::NetworkRunner(const RectifiedNetwork& network)
    : NetworkRunner(std::move(Of({&network}).front())) {}

std::vector<NetworkRunner> NetworkRunner::Of(const std::vector<const RectifiedNetwork*>& networks) {
  size_t count = 0, beyond = 0;  // as far as fetching ahead looks beyond a layer
  for (const RectifiedNetwork* network : networks) {
    count += LinesOf(*network);
    for (const RectifiedNetwork::Layer& layer : network->layers) {
      beyond = std::max(beyond, static_cast<size_t>(layer.weight.cols()));
    }
  }
  auto lines = std::make_shared<std::vector<WeightLine>>();
  lines->reserve(count + beyond);
  PreferLargePages(lines->data(), lines->capacity() * sizeof(WeightLine));  // before it has pages
  std::vector<NetworkRunner> runners(networks.size());
  for (size_t n = 0; n < networks.size(); ++n) {
    runners[n].Add(*networks[n], lines.get());
    runners[n].lines_ = lines;
  }
  lines->resize(count + beyond);
  return runners;
}

void NetworkRunner::Add(const RectifiedNetwork& network, std::vector<WeightLine>* lines) {
  network_.input_mean = network.input_mean;
  network_.input_scale = network.input_scale;
  nought_ = network_.Normalised(Eigen::VectorXf::Zero(network_.input_mean.size()));
  for (const RectifiedNetwork::Layer& layer : network.layers) {
    const auto units = static_cast<size_t>(layer.weight.rows());
    const auto inputs = static_cast<size_t>(layer.weight.cols());
    const size_t blocks = BlocksOf(layer, sizeof(WeightLine));
    const WeightBytes bytes = BytesOf(layer.weight);
    Layer& ready = layers_.emplace_back();
    ready.step = bytes.step;
    ready.at_zero = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(blocks * sizeof(WeightLine)));
    ready.at_zero.head(layer.bias.size()) = layer.bias;
    if (layers_.size() == 1) ready.at_zero.head(layer.bias.size()) += layer.weight * nought_;
    ready.first_line = lines->size();
    lines->resize(lines->size() + blocks * inputs, WeightLine{});
    for (size_t i = 0; i < inputs; ++i) {
      for (size_t unit = 0; unit < units; ++unit) {
        WeightLine& line = (*lines)[ready.first_line + unit / sizeof(WeightLine) * inputs + i];
        line.weights[PlaceOf(unit % sizeof(WeightLine))] =
            bytes.of(static_cast<Eigen::Index>(unit), static_cast<Eigen::Index>(i));
      }
    }
    outputs_ = layer.bias.size();
  }
}

template <size_t kColumns>
void NetworkRunner::RunColumns(const Eigen::Ref<const Eigen::MatrixXf>& inputs, Eigen::Index first,
                               Eigen::MatrixXf* outputs) const {
  std::array<Eigen::VectorXf, kColumns> values;
  for (size_t c = 0; c < kColumns; ++c) {
    values[c] = network_.Normalised(inputs.col(first + static_cast<Eigen::Index>(c))) - nought_;
  }
  std::vector<Term<kColumns>> terms;
  for (const Layer& layer : layers_) {
    if (&layer != &layers_.front()) {
      for (Eigen::VectorXf& value : values) value = value.cwiseMax(0.0F).eval();
    }
    const size_t count = TermsOf<kColumns>(values, layer.step, terms);
    values.fill(layer.at_zero);
    const WeightLine* lines = lines_->data() + layer.first_line;
    for (Eigen::Index unit = 0; unit < layer.at_zero.size(); unit += sizeof(WeightLine)) {
      const WeightLine* next_lines = lines + layer.step.size();  // of the last: only fetched
      std::array<float*, kColumns> sums;
      for (size_t c = 0; c < kColumns; ++c) sums[c] = values[c].data() + unit;
      if constexpr (kColumns == 1) {
        AddToOne(terms, count, lines, next_lines, sums);
      } else {
        AddToTwo(terms, count, lines, next_lines, sums);
      }
      lines = next_lines;
    }
  }
  for (size_t c = 0; c < kColumns; ++c) {
    outputs->col(first + static_cast<Eigen::Index>(c)) = values[c].head(outputs_);
  }
}

Eigen::MatrixXf NetworkRunner::Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const {
  Eigen::MatrixXf outputs(outputs_, inputs.cols());
  Eigen::Index c = 0;
  for (; c + 1 < inputs.cols(); c += 2) RunColumns<2>(inputs, c, &outputs);
  if (c < inputs.cols()) RunColumns<1>(inputs, c, &outputs);
  return outputs;
}

}  // namespace ossa::recon
