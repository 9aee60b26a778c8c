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

}  // namespace

// An input that says something, and by how much to take its weights.
struct NetworkRunner::Term {
  uint32_t input = 0;
  float factor = 0.0F;
};

// The terms of the factors that are not nought. Without a branch: which ones are not, nobody
// foresees. After them come the first ones again, whose weights for the next units are wanted next.
size_t NetworkRunner::TermsOf(const Eigen::VectorXf& factors, const Layer& layer,
                              std::vector<Term>& terms) {
  const auto inputs = static_cast<size_t>(layer.step.size());  // factors may be padded
  terms.resize(inputs + kAhead);
  size_t count = 0;
  for (size_t i = 0; i < inputs; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    terms[count] = {static_cast<uint32_t>(i), factors[at] * layer.step[at]};
    count += (std::bit_cast<uint32_t>(factors[at]) << 1U) != 0 ? 1 : 0;  // nought of any sign
  }
  for (size_t i = 0; i < kAhead; ++i) terms[count + i] = i < count ? terms[i] : Term{};
  return count;
}

// To the sums of the units of a line, which registers hold while all terms go by.
OSSA_CLONES void NetworkRunner::AddTerms(const std::vector<Term>& terms, size_t count,
                                         const Line* lines, const Line* next_lines, float* sums) {
  constexpr size_t kGroups = sizeof(Line) / kInWords;
  constexpr int32_t kHighest = static_cast<int32_t>(0xff000000U);
  Lanes sum[kGroups][sizeof(int32_t)];
  std::memcpy(sum, sums, sizeof(sum));
  const Term* term = terms.data();
  const Term* const end = term + count;
  const Term* const last_lap = term + (count - std::min(count, kAhead));
  for (; term < end; ++term) {
    __builtin_prefetch((term < last_lap ? lines : next_lines) + term[kAhead].input);
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

size_t NetworkRunner::LinesOf(const RectifiedNetwork& network) {
  size_t lines = 0;
  for (const RectifiedNetwork::Layer& layer : network.layers) {
    lines += BlocksOf(layer, sizeof(Line)) * static_cast<size_t>(layer.weight.cols());
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
  auto lines = std::make_shared<std::vector<Line>>();
  lines->reserve(count + beyond);
  PreferLargePages(lines->data(), lines->capacity() * sizeof(Line));  // before it has pages
  std::vector<NetworkRunner> runners(networks.size());
  for (size_t n = 0; n < networks.size(); ++n) {
    runners[n].Add(*networks[n], lines.get());
    runners[n].lines_ = lines;
  }
  lines->resize(count + beyond);
  return runners;
}

void NetworkRunner::Add(const RectifiedNetwork& network, std::vector<Line>* lines) {
  network_.input_mean = network.input_mean;
  network_.input_scale = network.input_scale;
  nought_ = network_.Normalised(Eigen::VectorXf::Zero(network_.input_mean.size()));
  for (const RectifiedNetwork::Layer& layer : network.layers) {
    const auto units = static_cast<size_t>(layer.weight.rows());
    const auto inputs = static_cast<size_t>(layer.weight.cols());
    const size_t blocks = BlocksOf(layer, sizeof(Line));
    const WeightBytes bytes = BytesOf(layer.weight);
    Layer& ready = layers_.emplace_back();
    ready.step = bytes.step;
    ready.at_zero = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(blocks * sizeof(Line)));
    ready.at_zero.head(layer.bias.size()) = layer.bias;
    if (layers_.size() == 1) ready.at_zero.head(layer.bias.size()) += layer.weight * nought_;
    ready.first_line = lines->size();
    lines->resize(lines->size() + blocks * inputs, Line{});
    for (size_t i = 0; i < inputs; ++i) {
      for (size_t unit = 0; unit < units; ++unit) {
        Line& line = (*lines)[ready.first_line + unit / sizeof(Line) * inputs + i];
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
      const Line* lines = lines_->data() + layer.first_line;
      for (Eigen::Index unit = 0; unit < value.size(); unit += sizeof(Line)) {
        const Line* next_lines = lines + layer.step.size();  // of the last: only fetched
        AddTerms(terms, count, lines, next_lines, value.data() + unit);
        lines = next_lines;
      }
    }
    outputs.col(c) = value.head(outputs_);
  }
  return outputs;
}

}  // namespace ossa::recon
