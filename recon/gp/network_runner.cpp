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

}  // namespace

NetworkRunner::NetworkRunner(RectifiedNetwork network) : network_(std::move(network)) {
  at_zero_ = network_.Normalised(Eigen::VectorXf::Zero(network_.input_mean.size()));
  const RectifiedNetwork::Layer& first = network_.layers.front();
  first_layer_ = first.weight * at_zero_ + first.bias;
  for (const float weight : first.weight.reshaped()) weights_.push_back(HalfOf(weight));
  network_.layers.front().weight.resize(0, 0);
}

Eigen::MatrixXf NetworkRunner::Run(const Eigen::Ref<const Eigen::MatrixXf>& inputs) const {
  const auto rows = static_cast<size_t>(first_layer_.size());
  Eigen::MatrixXf value = first_layer_.replicate(1, inputs.cols());
  for (Eigen::Index c = 0; c < inputs.cols(); ++c) {
    const Eigen::VectorXf moved = network_.Normalised(inputs.col(c)) - at_zero_;
    std::vector<Term> terms;
    terms.reserve(static_cast<size_t>(moved.size()));
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      if (inputs(i, c) == 0.0F) continue;
      terms.push_back({weights_.data() + static_cast<size_t>(i) * rows, moved[i]});
    }
    AddTerms(terms.data(), terms.size(), rows, value.col(c).data());
  }
  for (size_t l = 1; l < network_.layers.size(); ++l) {
    const RectifiedNetwork::Layer& layer = network_.layers[l];
    const Eigen::MatrixXf before = value.cwiseMax(0.0F);
    value = (layer.weight * before).colwise() + layer.bias;
  }
  return value;
}

}  // namespace ossa::recon
