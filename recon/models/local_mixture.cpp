// Z. Liu, L. Zhou, H. Leung, H. P. H. Shum, 2016, section 4.2.
#include "recon/models/local_mixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "depth/base/statistics.h"

namespace ossa::recon {
namespace {

Eigen::MatrixXd Rows(const Eigen::MatrixXd& m, const std::vector<int>& rows) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), m.cols());
  for (size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = m.row(rows[i]);
  return out;
}

std::vector<int> EveryNth(const std::vector<int>& rows, size_t most) {
  if (rows.size() <= most) return rows;
  std::vector<int> out;
  for (size_t i = 0; i < most; ++i) out.push_back(rows[i * rows.size() / most]);
  return out;
}

}  // namespace

std::vector<int> KMeans(const Eigen::MatrixXd& x, int regions, uint64_t seed, int iterations) {
  const Eigen::Index n = x.rows();
  const Eigen::Index k = std::min<Eigen::Index>(regions, n);
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  Eigen::MatrixXd centres(k, x.cols());
  centres.row(0) = x.row(static_cast<Eigen::Index>(uniform() * static_cast<double>(n)));
  Eigen::VectorXd nearest = (x.rowwise() - centres.row(0)).rowwise().squaredNorm();
  for (Eigen::Index c = 1; c < k; ++c) {
    double left = uniform() * nearest.sum();
    Eigen::Index pick = 0;
    while (pick + 1 < n && (left -= nearest[pick]) > 0.0) ++pick;
    centres.row(c) = x.row(pick);
    nearest = nearest.cwiseMin((x.rowwise() - centres.row(c)).rowwise().squaredNorm());
  }
  std::vector<int> region(static_cast<size_t>(n), 0);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Eigen::MatrixXd d = -2.0 * x * centres.transpose();
    d.rowwise() += centres.rowwise().squaredNorm().transpose();
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(k, x.cols());
    Eigen::VectorXd counts = Eigen::VectorXd::Zero(k);
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::Index best = 0;
      d.row(i).minCoeff(&best);
      region[static_cast<size_t>(i)] = static_cast<int>(best);
      sums.row(best) += x.row(i);
      counts[best] += 1.0;
    }
    for (Eigen::Index c = 0; c < k; ++c) {
      if (counts[c] > 0.0) centres.row(c) = sums.row(c) / counts[c];
    }
  }
  return region;
}

LocalMixture LocalMixture::Learn(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                                 const LocalMixtureOptions& options) {
  const std::vector<int> region = KMeans(inputs, options.regions, options.seed);
  GaussianProcessParameters start;
  std::vector<GaussianProcess> models;
  const int filled = region.empty() ? 0 : *std::max_element(region.begin(), region.end()) + 1;
  for (int q = 0; q < filled; ++q) {
    std::vector<int> rows;
    for (size_t i = 0; i < region.size(); ++i) {
      if (region[i] == q) rows.push_back(static_cast<int>(i));
    }
    if (rows.empty()) continue;
    // Departure: the paper uses all samples of a region for learning and budgeting. Both have cubic
    // cost: the parameters are learned from S samples, and budgeting starts from four times the
    // budget.
    rows = EveryNth(rows, static_cast<size_t>(4 * options.samples));
    const std::vector<int> some = EveryNth(rows, static_cast<size_t>(options.samples));
    const auto parameters = LearnParameters(Rows(inputs, some), Rows(outputs, some), start);
    Eigen::MatrixXd x = Rows(inputs, rows), y = Rows(outputs, rows);
    const std::vector<int> kept = BudgetedSamples(parameters, x, y, options.samples);
    models.emplace_back(parameters, Rows(x, kept), Rows(y, kept));
  }
  return LocalMixture(std::move(models));
}

LocalMixture::LocalMixture(std::vector<GaussianProcess> models) : models_(std::move(models)) {
  std::vector<double> widths;
  for (const GaussianProcess& model : models_) {
    centres_.emplace_back(model.inputs().colwise().mean().transpose());
    widths.push_back(model.parameters().w);
  }
  if (widths.empty()) return;
  w_ = Median(std::move(widths));
}

double LocalMixture::LogSimilarity(size_t model, const Eigen::VectorXd& input) const {
  return -0.5 * w_ * (input - centres_[model]).squaredNorm();
}

GaussianPrediction LocalMixture::Predict(const Eigen::VectorXd& input, int nearby) const {
  std::vector<std::pair<double, size_t>> similar;
  for (size_t q = 0; q < models_.size(); ++q) similar.emplace_back(-LogSimilarity(q, input), q);
  const size_t l = std::min(similar.size(), static_cast<size_t>(nearby));
  std::partial_sort(similar.begin(), similar.begin() + static_cast<ptrdiff_t>(l), similar.end());
  GaussianPrediction out;
  double total = 0.0;
  for (size_t k = 0; k < l; ++k) {
    // Eq. 12, relative to the most similar model, so that weights far from all models are not 0 /
    // 0.
    const double weight = std::exp(similar[0].first - similar[k].first);
    if (weight < 1e-4) break;
    const GaussianPrediction local = models_[similar[k].second].Predict(input);
    out.mean += weight * local.mean;
    out.variance += weight * local.variance;
    out.noise += weight * local.noise;
    total += weight;
  }
  if (total > 0.0) out.mean /= total, out.variance /= total, out.noise /= total;
  return out;
}

size_t LocalMixture::MostSimilar(const Eigen::VectorXd& input) const {
  size_t best = 0;
  for (size_t q = 1; q < models_.size(); ++q) {
    if (LogSimilarity(q, input) > LogSimilarity(best, input)) best = q;
  }
  return best;
}

double LocalMixture::Similarity(const Eigen::VectorXd& input) const {
  return models_.empty() ? 0.0 : std::exp(LogSimilarity(MostSimilar(input), input));
}

void LocalMixture::Update(const Eigen::VectorXd& input, const Eigen::Vector3d& output,
                          const LocalMixtureOptions& options) {
  if (models_.empty()) return;
  const size_t best = MostSimilar(input);
  if (std::exp(LogSimilarity(best, input)) <= options.w_similar) {
    if (static_cast<int>(models_.size()) >= options.most_models) return;
    models_.emplace_back(models_[best].parameters(), input.transpose(), output.transpose());
    centres_.push_back(input);
    return;
  }
  GaussianProcess& model = models_[best];
  model.Add(input, output);
  if (model.size() > options.most_samples) {
    const int keep = std::max(1, options.most_samples * 9 / 10);
    const auto kept = BudgetedSamples(model.parameters(), model.inputs(), model.outputs(), keep);
    model = GaussianProcess(model.parameters(), Rows(model.inputs(), kept),
                            Rows(model.outputs(), kept));
  }
  centres_[best] = model.inputs().colwise().mean().transpose();
}

}  // namespace ossa::recon
