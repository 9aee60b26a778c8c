#include "recon/models/rectified_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "depth/base/checksummed_container.h"
#include "depth/base/cpu_dispatch.h"

namespace ossa::recon {
namespace {

// Constants: bounds and units of the format, by hand.

constexpr float kMost = 1e6F;        // of anything in a network; no unit
constexpr float kMostByte = 127.0F;  // of a weight

void PutFloats(PayloadWriter& out, const Eigen::VectorXf& numbers) {
  out.PutArray(std::span<const float>(numbers.data(), static_cast<size_t>(numbers.size())));
}

void PutHalves(PayloadWriter& out, const Eigen::Ref<const Eigen::MatrixXf>& numbers) {
  std::vector<uint16_t> halves;
  for (const float number : numbers.reshaped()) halves.push_back(HalfOf(number));
  out.PutVector(halves);
}

void Check(const PayloadReader& in, std::string_view field, size_t found, Eigen::Index count) {
  if (found != static_cast<size_t>(count)) {
    in.Fail(field, fmt::format("expected {} numbers", count));
  }
}

// A column's weights as steps, of which the largest is kMostByte.
OSSA_CPU_DISPATCH void ToSteps(const float* weights, float step, size_t count, int8_t* steps) {
  for (size_t i = 0; i < count; ++i) {
    steps[i] = static_cast<int8_t>(std::clamp(std::rint(weights[i] / step), -kMostByte, kMostByte));
  }
}

void CheckModest(const PayloadReader& in, std::string_view field, float number) {
  if (!(std::abs(number) <= kMost)) in.Fail(field, "expected numbers of at most a million");
}

Eigen::VectorXf GetFloats(PayloadReader& in, std::string_view field, Eigen::Index count) {
  const auto numbers = in.GetVector<float>(field);
  Check(in, field, numbers.size(), count);
  for (const float number : numbers) CheckModest(in, field, number);
  return Eigen::Map<const Eigen::VectorXf>(numbers.data(), count);
}

Eigen::MatrixXf GetHalves(PayloadReader& in, std::string_view field, Eigen::Index rows,
                          Eigen::Index columns) {
  const auto halves = in.GetVector<uint16_t>(field);
  Check(in, field, halves.size(), rows * columns);
  Eigen::MatrixXf numbers(rows, columns);
  for (size_t i = 0; i < halves.size(); ++i) {
    const float number = OfHalf(halves[i]);
    CheckModest(in, field, number);
    numbers.reshaped()[static_cast<Eigen::Index>(i)] = number;
  }
  return numbers;
}

void PutBytes(PayloadWriter& out, const Eigen::MatrixXf& weight) {
  const WeightBytes bytes = BytesOf(weight);
  PutFloats(out, bytes.step);
  out.PutArray(std::span<const int8_t>(bytes.of.data(), static_cast<size_t>(bytes.of.size())));
}

Eigen::MatrixXf GetBytes(PayloadReader& in, std::string_view field, Eigen::Index rows,
                         Eigen::Index columns) {
  WeightBytes bytes;
  bytes.step = GetFloats(in, field, columns);
  for (const float step : bytes.step) CheckModest(in, field, kMostByte * step);
  const auto of = in.GetVector<int8_t>(field);
  Check(in, field, of.size(), rows * columns);
  bytes.of = Eigen::Map<const decltype(bytes.of)>(of.data(), rows, columns);
  return bytes.Weights();
}

}  // namespace

uint16_t HalfOf(float number) {
  const uint32_t half = std::isfinite(number) ? 0x8000U : 0U;  // rounded, but not NaN to a number
  return static_cast<uint16_t>((std::bit_cast<uint32_t>(number) + half) >> 16U);
}

Eigen::VectorXf RectifiedNetwork::Normalised(const Eigen::Ref<const Eigen::VectorXf>& input) const {
  // What was never seen while it was learned is taken for the most that was.
  constexpr float kFarthest = 5.0F;  // standard deviations
  return (input - input_mean).cwiseProduct(input_scale).cwiseMin(kFarthest).cwiseMax(-kFarthest);
}

Eigen::VectorXf RectifiedNetwork::Run(const Eigen::Ref<const Eigen::VectorXf>& input) const {
  Eigen::VectorXf value = Normalised(input);
  for (size_t l = 0; l < layers.size(); ++l) {
    if (l > 0) value = value.cwiseMax(0.0F);
    value = (layers[l].weight * value + layers[l].bias).eval();
  }
  return value;
}

Eigen::MatrixXf WeightBytes::Weights() const { return of.cast<float>() * step.asDiagonal(); }

WeightBytes BytesOf(const Eigen::MatrixXf& weight) {
  WeightBytes bytes{{weight.rows(), weight.cols()}, Eigen::VectorXf::Zero(weight.cols())};
  bytes.of.setZero();
  for (Eigen::Index i = 0; i < weight.cols(); ++i) {
    // In halves of floats, 127 steps are a float and divided by 127 a step again.
    const float largest = weight.col(i).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    const float step = OfHalf(HalfOf(largest / kMostByte));
    bytes.step[i] = step;
    if (!(step > 0.0F && std::isfinite(step))) continue;  // nothing that could be told in steps
    ToSteps(weight.col(i).data(), step, static_cast<size_t>(weight.rows()), bytes.of.col(i).data());
  }
  return bytes;
}

void PutNetwork(PayloadWriter& out, const RectifiedNetwork& network, WeightForm form) {
  PutFloats(out, network.input_mean);
  PutFloats(out, network.input_scale);
  for (const RectifiedNetwork::Layer& layer : network.layers) {
    form == WeightForm::kBytes ? PutBytes(out, layer.weight) : PutHalves(out, layer.weight);
    PutHalves(out, layer.bias);
  }
}

Eigen::Index GetUnits(PayloadReader& in) {
  constexpr uint32_t kMostUnits = 1 << 14;
  const auto units = in.Get<uint32_t>("units");
  if (units < 1 || units > kMostUnits) {
    in.Fail("units", fmt::format("expected 1 to {}", kMostUnits));
  }
  return units;
}

RectifiedNetwork GetNetwork(PayloadReader& in, const std::vector<Eigen::Index>& sizes,
                            WeightForm form) {
  RectifiedNetwork network;
  network.input_mean = GetFloats(in, "input means", sizes.front());
  network.input_scale = GetFloats(in, "input scales", sizes.front());
  for (size_t l = 1; l < sizes.size(); ++l) {
    const std::string layer = l + 1 == sizes.size() ? "output" : "unit";
    RectifiedNetwork::Layer& added = network.layers.emplace_back();
    const auto get = form == WeightForm::kBytes ? GetBytes : GetHalves;
    added.weight = get(in, layer + " weights", sizes[l], sizes[l - 1]);
    added.bias = GetHalves(in, layer + " biases", sizes[l], 1);
  }
  return network;
}

}  // namespace ossa::recon
