#include "depth/base/perceptron/quantised_perceptron.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "depth/base/large_pages.h"
#include "depth/base/perceptron/perceptron_file.h"
#include "depth/base/perceptron/round_numbers_internal.h"
#include "depth/base/perceptron/weight_sums_internal.h"

namespace ossa {
namespace {

size_t CountPairs(Eigen::Index inputs) { return (static_cast<size_t>(inputs) + 1) / 2; }

// Largest quantised factor: the sum of all factors times a byte each stays below 2^31.
float MostQuanta(size_t factors) {
  constexpr size_t kMostSum = std::numeric_limits<int32_t>::max();
  constexpr size_t kMostWeight = std::numeric_limits<int8_t>::max();
  constexpr size_t kMost = std::numeric_limits<int16_t>::max();
  return static_cast<float>(std::min(kMost, kMostSum / (kMostWeight * factors)));
}

// Quantises an example's factors and returns the scale.
template <size_t kExamples>
float Quantise(const Eigen::RowVectorXf& factors, size_t example,
               std::vector<PairFactors<kExamples>>* pairs) {
  const auto count = static_cast<size_t>(factors.size());
  const float most = MostQuanta(count);
  const float largest = factors.cwiseAbs().maxCoeff();
  if (!(largest / most > std::numeric_limits<float>::min())) return 0.0F;  // all zero
  std::vector<int16_t> rounded(2 * pairs->size());  // the last pair may be incomplete
  RoundNumbers(factors.data(), most / largest, count, rounded.data());
  for (size_t pair = 0; pair < pairs->size(); ++pair) {
    std::memcpy(&(*pairs)[pair][example], &rounded[2 * pair], sizeof((*pairs)[pair][example]));
  }
  return largest / most;
}

}  // namespace

QuantisedPerceptron::QuantisedPerceptron(const Perceptron& perceptron) {
  PerceptronPacker packer(0);
  packer.Add(perceptron);
  *this = std::move(packer.Take().front());
}

PerceptronPacker::PerceptronPacker(size_t weights)
    : lines_(std::make_shared<std::vector<WeightLine>>()) {
  // By hand: estimated share of padding weights, one in this many.
  constexpr size_t kPadding = 64;
  lines_->reserve((weights + weights / kPadding) / sizeof(WeightLine));
  PreferLargePages(lines_->data(), lines_->capacity() * sizeof(WeightLine));  // before it has pages
}

void PerceptronPacker::Add(const Perceptron& perceptron) {
  packed_.emplace_back().Add(perceptron, lines_.get());
}

std::vector<QuantisedPerceptron> PerceptronPacker::Take() {
  for (QuantisedPerceptron& each : packed_) each.lines_ = lines_;
  return std::move(packed_);
}

void QuantisedPerceptron::Add(const Perceptron& perceptron, std::vector<WeightLine>* lines) {
  normaliser_.input_mean = perceptron.input_mean;
  normaliser_.input_scale = perceptron.input_scale;
  for (const PerceptronLayer& layer : perceptron.layers) {
    const auto inputs = static_cast<size_t>(layer.weight.rows());
    const auto units = static_cast<size_t>(layer.weight.cols());
    const size_t blocks = CountLines(layer.weight.cols(), WeightLine::kUnits);
    const size_t pairs = CountPairs(layer.weight.rows());
    const WeightBytes rounded = RoundToBytes(layer.weight);
    layers_.push_back({lines->size(), blocks, rounded.step, layer.bias});
    lines->resize(lines->size() + blocks * pairs);
    WeightLine* const first = lines->data() + layers_.back().first_line;
    for (size_t i = 0; i < inputs; ++i) {
      for (size_t unit = 0; unit < units; ++unit) {
        WeightLine& line = first[unit / WeightLine::kUnits * pairs + i / 2];
        line.weights[unit % WeightLine::kUnits][i % 2] =
            rounded.bytes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(unit));
      }
    }
  }
}

template <size_t kExamples>
void QuantisedPerceptron::RunSideBySide(const RowMatrix& normalised, Eigen::Index first,
                                        RowMatrix* outputs) const {
  std::array<Eigen::RowVectorXf, kExamples> values;
  for (size_t e = 0; e < kExamples; ++e) {
    values[e] = normalised.row(first + static_cast<Eigen::Index>(e));
  }
  std::vector<PairFactors<kExamples>> factors;
  std::array<std::vector<int32_t>, kExamples> sums;
  for (const Layer& layer : layers_) {
    factors.assign(CountPairs(layer.step.size()), {});
    std::array<float, kExamples> quantum;
    WeightSums<kExamples> of{
        .factors = factors, .lines = lines_->data() + layer.first_line, .blocks = layer.blocks};
    for (size_t e = 0; e < kExamples; ++e) {
      if (&layer != &layers_.front()) values[e] = values[e].cwiseMax(0.0F).eval();
      quantum[e] = Quantise<kExamples>(values[e].cwiseProduct(layer.step), e, &factors);
      sums[e].resize(layer.blocks * WeightLine::kUnits);
      of.sums[e] = sums[e].data();
    }
    AddWeights(of);
    for (size_t e = 0; e < kExamples; ++e) {
      const Eigen::Map<const Eigen::RowVectorXi> sum(sums[e].data(), layer.bias.size());
      values[e] = layer.bias + quantum[e] * sum.cast<float>();
    }
  }
  for (size_t e = 0; e < kExamples; ++e) {
    outputs->row(first + static_cast<Eigen::Index>(e)) = values[e];
  }
}

RowMatrix QuantisedPerceptron::Run(const Eigen::Ref<const RowMatrix>& inputs) const {
  const RowMatrix normalised = normaliser_.Normalise(inputs);
  RowMatrix outputs(inputs.rows(), layers_.back().bias.size());
  Eigen::Index e = 0;
  for (; e + 1 < inputs.rows(); e += 2) RunSideBySide<2>(normalised, e, &outputs);
  if (e < inputs.rows()) RunSideBySide<1>(normalised, e, &outputs);
  return outputs;
}

}  // namespace ossa
