#include "depth/base/perceptron/perceptron_file.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "depth/base/checksummed_container.h"
#include "depth/base/cpu_dispatch.h"

namespace ossa {
namespace {

constexpr float kMost = 1e6F;  // bound of all numbers, no unit; by hand: their sums stay finite
constexpr float kMostByte = 127.0F;  // largest weight; derived: the largest int8_t

template <typename Numbers>
void PutFloats(PayloadWriter& out, const Numbers& numbers) {
  out.PutArray(std::span<const float>(numbers.data(), static_cast<size_t>(numbers.size())));
}

// Writes the numbers row by row.
template <typename Numbers>
std::span<const float> Flat(const Numbers& numbers) {
  return {numbers.data(), static_cast<size_t>(numbers.size())};
}

void PutBytes(PayloadWriter& out, const RowMatrix& weight) {
  const WeightBytes rounded = RoundToBytes(weight);
  PutFloats(out, rounded.step);
  out.PutArray(
      std::span<const int8_t>(rounded.bytes.data(), static_cast<size_t>(rounded.bytes.size())));
}

void CheckCount(const PayloadReader& in, std::string_view field, size_t found, Eigen::Index count) {
  if (found != static_cast<size_t>(count)) {
    in.Fail(field, "expected " + std::to_string(count) + " numbers");
  }
}

void CheckModest(const PayloadReader& in, std::string_view field, float number) {
  if (!(std::abs(number) <= kMost)) in.Fail(field, "expected numbers of at most a million");
}

RowMatrix GetBytes(PayloadReader& in, std::string_view field, Eigen::Index rows,
                   Eigen::Index columns) {
  WeightBytes rounded;
  rounded.step = GetFloats(in, field, rows);
  for (const float step : rounded.step) CheckModest(in, field, kMostByte * step);
  const auto bytes = in.GetVector<int8_t>(field);
  CheckCount(in, field, bytes.size(), rows * columns);
  rounded.bytes = Eigen::Map<const decltype(rounded.bytes)>(bytes.data(), rows, columns);
  return rounded.ToWeights();
}

// Quantises an input's weights; the largest becomes kMostByte.
OSSA_CPU_DISPATCH void DivideIntoSteps(const float* weights, float step, size_t count,
                                       int8_t* steps) {
  for (size_t i = 0; i < count; ++i) {
    steps[i] = static_cast<int8_t>(std::clamp(std::rint(weights[i] / step), -kMostByte, kMostByte));
  }
}

}  // namespace

void PutHalves(PayloadWriter& out, std::span<const float> numbers) {
  std::vector<uint16_t> halves(numbers.size());
  std::ranges::transform(numbers, halves.begin(), RoundToHalf);
  out.PutVector(halves);
}

RowMatrix GetHalves(PayloadReader& in, std::string_view field, Eigen::Index rows,
                    Eigen::Index columns) {
  const auto halves = in.GetVector<uint16_t>(field);
  CheckCount(in, field, halves.size(), rows * columns);
  RowMatrix numbers(rows, columns);
  for (size_t i = 0; i < halves.size(); ++i) {
    const float number = ExpandHalf(halves[i]);
    CheckModest(in, field, number);
    numbers.data()[i] = number;
  }
  return numbers;
}

Eigen::VectorXf GetFloats(PayloadReader& in, std::string_view field, Eigen::Index count) {
  const auto numbers = in.GetVector<float>(field);
  CheckCount(in, field, numbers.size(), count);
  for (const float number : numbers) CheckModest(in, field, number);
  return Eigen::Map<const Eigen::VectorXf>(numbers.data(), count);
}

bool AreModest(const RowMatrix& numbers) {
  return std::all_of(numbers.data(), numbers.data() + numbers.size(),
                     [](float number) { return std::abs(number) <= kMost; });
}

uint16_t RoundToHalf(float number) {
  const uint32_t half = std::isfinite(number) ? 0x8000U : 0U;  // rounds to nearest, but keeps NaN
  return static_cast<uint16_t>((std::bit_cast<uint32_t>(number) + half) >> 16U);
}

RowMatrix WeightBytes::ToWeights() const { return step.asDiagonal() * bytes.cast<float>(); }

WeightBytes RoundToBytes(const RowMatrix& weight) {
  WeightBytes rounded;
  rounded.bytes.setZero(weight.rows(), weight.cols());
  rounded.step.setZero(weight.rows());
  for (Eigen::Index i = 0; i < weight.rows(); ++i) {
    // Chosen so that 127 steps are exactly a half, and the step is recovered by dividing by 127.
    const float largest = weight.row(i).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    const float step = ExpandHalf(RoundToHalf(largest / kMostByte));
    rounded.step[i] = step;
    if (!(step > 0.0F && std::isfinite(step))) continue;  // not representable in steps
    DivideIntoSteps(weight.row(i).data(), step, static_cast<size_t>(weight.cols()),
                    rounded.bytes.row(i).data());
  }
  return rounded;
}

void PutPerceptron(PayloadWriter& out, const Perceptron& perceptron, WeightForm form) {
  PutFloats(out, perceptron.input_mean);
  PutFloats(out, perceptron.input_scale);
  for (const PerceptronLayer& layer : perceptron.layers) {
    form == WeightForm::kBytes ? PutBytes(out, layer.weight) : PutHalves(out, Flat(layer.weight));
    PutHalves(out, Flat(layer.bias));
  }
}

Eigen::Index GetUnits(PayloadReader& in) {
  constexpr uint32_t kMostUnits = 1 << 14;  // by hand: 64 times what any model of ours has
  const auto units = in.Get<uint32_t>("units");
  if (units < 1 || units > kMostUnits) {
    in.Fail("units", "expected 1 to " + std::to_string(kMostUnits));
  }
  return units;
}

Perceptron GetPerceptron(PayloadReader& in, const std::vector<Eigen::Index>& sizes,
                         WeightForm form) {
  Perceptron perceptron;
  perceptron.input_mean = GetFloats(in, "input means", sizes.front());
  perceptron.input_scale = GetFloats(in, "input scales", sizes.front());
  for (size_t l = 1; l < sizes.size(); ++l) {
    const std::string name = l + 1 == sizes.size() ? "output" : "unit";
    PerceptronLayer& layer = perceptron.layers.emplace_back();
    const auto get = form == WeightForm::kBytes ? GetBytes : GetHalves;
    layer.weight = get(in, name + " weights", sizes[l - 1], sizes[l]);
    layer.bias = GetHalves(in, name + " biases", 1, sizes[l]);
  }
  return perceptron;
}

}  // namespace ossa
