#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/experiments/indoor_scenes/person_weights_internal.h"

namespace ossa::tools {

using Eigen::MatrixXd;
using Eigen::VectorXd;

PixelShares MeasureShares(const std::vector<int32_t>& pixels, const LabelledFrame& truth) {
  std::array<double, 256> common{}, whole{};
  for (const uint8_t user : truth.users.data) whole[user] += 1;
  for (const int32_t pixel : pixels) common[truth.users.data[static_cast<size_t>(pixel)]] += 1;
  const auto best = std::max_element(common.begin() + 1, common.end());
  return {*best / static_cast<double>(pixels.size()),
          *best / std::max(1.0, whole[static_cast<size_t>(best - common.begin())])};
}

double ScoreLogistic(const VectorXd& weights, const VectorXd& terms) {
  return 1 / (1 + std::exp(-weights.dot(terms)));
}

VectorXd FitLogistic(const std::vector<LogisticExample>& examples, double prior) {
  const Eigen::Index n = examples.at(0).terms.size();
  const auto people = static_cast<double>(
      std::ranges::count_if(examples, [](const LogisticExample& e) { return e.person; }));
  const double half = 0.5 * static_cast<double>(examples.size());
  const double others = std::max(1.0, 2 * half - people);
  VectorXd w = VectorXd::Zero(n);
  for (int step = 0; step < 30; ++step) {
    VectorXd gradient = prior * w;
    MatrixXd hessian = MatrixXd::Identity(n, n) * prior;
    gradient[0] = 0, hessian(0, 0) = 1e-9;  // the constant is free
    for (const LogisticExample& e : examples) {
      const double p = ScoreLogistic(w, e.terms);
      const double weight = half / (e.person ? people : others);
      gradient += weight * (p - (e.person ? 1.0 : 0.0)) * e.terms;
      hessian.selfadjointView<Eigen::Lower>().rankUpdate(e.terms, weight * p * (1 - p));
    }
    const VectorXd change =
        MatrixXd(hessian.selfadjointView<Eigen::Lower>()).ldlt().solve(gradient);
    w -= change;
    if (change.norm() < 1e-6 * (1 + w.norm())) break;
  }
  return w;
}

void AddPassedRows(const std::string& what, const VectorXd& weights,
                   const std::vector<LogisticExample>& examples, Table& table) {
  const auto share = [](int passed, int of) {
    return fmt::format("{} of {} ({:.1f} %)", passed, of, 100.0 * passed / std::max(1, of));
  };
  for (const double threshold : {0.1, 0.25, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95}) {
    int people = 0, passed = 0, others = 0, wrong = 0;
    for (const LogisticExample& e : examples) {
      const bool passes = ScoreLogistic(weights, e.terms) >= threshold;
      (e.person ? people : others) += 1;
      (e.person ? passed : wrong) += passes ? 1 : 0;
    }
    table.rows.push_back(
        {what, fmt::format("{}", threshold), share(passed, people), share(wrong, others)});
  }
}

std::string ArrayText(const std::string& name, const VectorXd& weights) {
  std::string text = fmt::format("constexpr std::array<double, {}> {} = {{", weights.size(), name);
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    text += fmt::format("{}{:.3f},", i % 10 == 0 ? "\n    " : " ", weights[i]);
  return text + "\n};\n";
}

}  // namespace ossa::tools
