#include "recon/gp/network_runner.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "depth/clones.h"

namespace ossa::recon {
namespace {

// An input that says something: its column of the weights, and by how much to take it.
struct Term {
  const uint16_t* column = nullptr;  // halves of floats
  float factor = 0.0F;
};

// Four columns at a time: the sums are read and written a quarter as often.
OSSA_CLONES void AddTerms(const Term* terms, size_t count, size_t rows, float* __restrict sums) {
  constexpr size_t kLine = 64 / sizeof(uint16_t);  // of the cache
  constexpr size_t kAhead = 16;                    // columns fetched while others are added
  size_t next = 0;
  for (; next + 4 <= count; next += 4) {
    for (size_t ahead = next + kAhead; ahead < std::min(next + kAhead + 4, count); ++ahead) {
      for (size_t r = 0; r < rows; r += kLine) __builtin_prefetch(terms[ahead].column + r);
    }
    const Term a = terms[next], b = terms[next + 1], c = terms[next + 2], d = terms[next + 3];
    for (size_t r = 0; r < rows; ++r) {
      sums[r] += a.factor * OfHalf(a.column[r]) + b.factor * OfHalf(b.column[r]) +
                 c.factor * OfHalf(c.column[r]) + d.factor * OfHalf(d.column[r]);
    }
  }
  for (; next < count; ++next) {
    const Term a = terms[next];
    for (size_t r = 0; r < rows; ++r) sums[r] += a.factor * OfHalf(a.column[r]);
  }
}

// `at_zero` and what each factor that is not nought adds; `terms` is room to work in.
Eigen::VectorXf Sum(const std::vector<uint16_t>& weights, const Eigen::VectorXf& at_zero,
                    const Eigen::VectorXf& factors, std::vector<Term>& terms) {
  const auto rows = static_cast<size_t>(at_zero.size());
  terms.clear();
  for (Eigen::Index i = 0; i < factors.size(); ++i) {
    if (factors[i] == 0.0F) continue;
    terms.push_back({weights.data() + static_cast<size_t>(i) * rows, factors[i]});
  }
  Eigen::VectorXf sums = at_zero;
  AddTerms(terms.data(), terms.size(), rows, sums.data());
  return sums;
}

}  // namespace

NetworkRunner::NetworkRunner(RectifiedNetwork network) : network_(std::move(network)) {
  nought_ = network_.Normalised(Eigen::VectorXf::Zero(network_.input_mean.size()));
  for (const RectifiedNetwork::Layer& layer : std::exchange(network_.layers, {})) {
    Layer& ready = layers_.emplace_back();
    ready.at_zero = layer.bias;
    if (layers_.size() == 1) ready.at_zero += layer.weight * nought_;
    for (const float weight : layer.weight.reshaped()) ready.weights.push_back(HalfOf(weight));
  }
}

Eigen::MatrixXf NetworkRunner::Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const {
  Eigen::MatrixXf outputs(layers_.back().at_zero.size(), inputs.cols());
  std::vector<Term> terms;
  terms.reserve(static_cast<size_t>(inputs.rows()));
  for (Eigen::Index c = 0; c < inputs.cols(); ++c) {
    Eigen::VectorXf value = network_.Normalised(inputs.col(c)) - nought_;
    for (size_t l = 0; l < layers_.size(); ++l) {
      if (l > 0) value = value.cwiseMax(0.0F).eval();
      value = Sum(layers_[l].weights, layers_[l].at_zero, value, terms);
    }
    outputs.col(c) = value;
  }
  return outputs;
}

}  // namespace ossa::recon
