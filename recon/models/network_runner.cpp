#include "recon/models/network_runner.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/large_pages.h"
#include "recon/models/weight_sums_internal.h"

namespace ossa::recon {
namespace {

size_t PairsOf(size_t inputs) { return (inputs + 1) / 2; }

size_t PairsOf(const RectifiedNetwork::Layer& layer) {
  return PairsOf(static_cast<size_t>(layer.weight.cols()));
}

// How often a line is filled by the weights of a pair of inputs.
size_t BlocksOf(const RectifiedNetwork::Layer& layer) {
  return (static_cast<size_t>(layer.weight.rows()) + WeightLine::kUnits - 1) / WeightLine::kUnits;
}

// So many quanta at most is a factor: then sums of all of them times a byte each stay below 2^31.
float MostQuanta(size_t factors) {
  constexpr size_t kMostSum = std::numeric_limits<int32_t>::max();
  constexpr size_t kMostWeight = std::numeric_limits<int8_t>::max();
  constexpr size_t kMost = std::numeric_limits<int16_t>::max();
  return static_cast<float>(std::min(kMost, kMostSum / (kMostWeight * factors)));
}

// To the nearest whole numbers.
OSSA_CPU_DISPATCH void Round(const float* numbers, float times, size_t count, int16_t* rounded) {
  for (size_t i = 0; i < count; ++i) {
    rounded[i] = static_cast<int16_t>(std::rint(numbers[i] * times));
  }
}

// Puts the factors into a column, in quanta, and says how much a quantum is.
template <size_t kColumns>
float PutQuanta(const Eigen::VectorXf& factors, size_t column,
                std::vector<PairFactors<kColumns>>* pairs) {
  const auto count = static_cast<size_t>(factors.size());
  const float most = MostQuanta(count);
  const float largest = factors.cwiseAbs().maxCoeff();
  if (!(largest / most > std::numeric_limits<float>::min())) return 0.0F;  // nothing is said
  std::vector<int16_t> rounded(2 * pairs->size());  // the last pair may be half of one
  Round(factors.data(), most / largest, count, rounded.data());
  for (size_t pair = 0; pair < pairs->size(); ++pair) {
    std::memcpy(&(*pairs)[pair][column], &rounded[2 * pair], sizeof((*pairs)[pair][column]));
  }
  return largest / most;
}

}  // namespace

NetworkRunner::NetworkRunner(const RectifiedNetwork& network)
    : NetworkRunner(std::move(Of({&network}).front())) {}

std::vector<NetworkRunner> NetworkRunner::Of(const std::vector<const RectifiedNetwork*>& networks) {
  size_t count = 0;
  for (const RectifiedNetwork* network : networks) {
    for (const RectifiedNetwork::Layer& layer : network->layers) {
      count += BlocksOf(layer) * PairsOf(layer);
    }
  }
  auto lines = std::make_shared<std::vector<WeightLine>>();
  lines->reserve(count);
  PreferLargePages(lines->data(), lines->capacity() * sizeof(WeightLine));  // before it has pages
  std::vector<NetworkRunner> runners(networks.size());
  for (size_t n = 0; n < networks.size(); ++n) {
    runners[n].Add(*networks[n], lines.get());
    runners[n].lines_ = lines;
  }
  return runners;
}

void NetworkRunner::Add(const RectifiedNetwork& network, std::vector<WeightLine>* lines) {
  network_.input_mean = network.input_mean;
  network_.input_scale = network.input_scale;
  for (const RectifiedNetwork::Layer& layer : network.layers) {
    const auto units = static_cast<size_t>(layer.weight.rows());
    const auto inputs = static_cast<size_t>(layer.weight.cols());
    const size_t blocks = BlocksOf(layer), pairs = PairsOf(layer);
    const WeightBytes bytes = BytesOf(layer.weight);
    layers_.push_back({lines->size(), blocks, bytes.step, layer.bias});
    lines->resize(lines->size() + blocks * pairs);
    WeightLine* const first = lines->data() + layers_.back().first_line;
    for (size_t i = 0; i < inputs; ++i) {
      for (size_t unit = 0; unit < units; ++unit) {
        WeightLine& line = first[unit / WeightLine::kUnits * pairs + i / 2];
        line.weights[unit % WeightLine::kUnits][i % 2] =
            bytes.of(static_cast<Eigen::Index>(unit), static_cast<Eigen::Index>(i));
      }
    }
  }
}

template <size_t kColumns>
void NetworkRunner::RunColumns(const Eigen::Ref<const Eigen::MatrixXf>& inputs, Eigen::Index first,
                               Eigen::MatrixXf* outputs) const {
  std::array<Eigen::VectorXf, kColumns> values;
  for (size_t c = 0; c < kColumns; ++c) {
    values[c] = network_.Normalised(inputs.col(first + static_cast<Eigen::Index>(c)));
  }
  std::vector<PairFactors<kColumns>> factors;
  std::array<std::vector<int32_t>, kColumns> sums;
  for (const Layer& layer : layers_) {
    factors.assign(PairsOf(static_cast<size_t>(layer.step.size())), {});
    std::array<float, kColumns> quantum;
    WeightSums<kColumns> of{
        .factors = factors, .lines = lines_->data() + layer.first_line, .blocks = layer.blocks};
    for (size_t c = 0; c < kColumns; ++c) {
      if (&layer != &layers_.front()) values[c] = values[c].cwiseMax(0.0F).eval();
      quantum[c] = PutQuanta<kColumns>(values[c].cwiseProduct(layer.step), c, &factors);
      sums[c].resize(layer.blocks * WeightLine::kUnits);
      of.sums[c] = sums[c].data();
    }
    AddWeights(of);
    for (size_t c = 0; c < kColumns; ++c) {
      const Eigen::Map<const Eigen::VectorXi> sum(sums[c].data(), layer.bias.size());
      values[c] = layer.bias + quantum[c] * sum.cast<float>();
    }
  }
  for (size_t c = 0; c < kColumns; ++c) {
    outputs->col(first + static_cast<Eigen::Index>(c)) = values[c];
  }
}

Eigen::MatrixXf NetworkRunner::Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const {
  Eigen::MatrixXf outputs(layers_.back().bias.size(), inputs.cols());
  Eigen::Index c = 0;
  for (; c + 1 < inputs.cols(); c += 2) RunColumns<2>(inputs, c, &outputs);
  if (c < inputs.cols()) RunColumns<1>(inputs, c, &outputs);
  return outputs;
}

}  // namespace ossa::recon
