// Mean shift finds each target independently, but joints are connected. The positions of all
// targets of an object seen in one context follow a factor model (learned from training truth).
// Each target's modes are alternatives, or all wrong: y ~ Σ_m w_m N(x, s²) + w_0 · constant.
// Expectation propagation (Minka 2001): the prediction of a target by all others (its "cavity")
// weights its modes; the weighted modes then contribute to the predictions of the others. Three
// rounds after the first suffice.
#include "forest/proposals/pose_inference_internal.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "forest/runtime_tables_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand on validation subjects (`ossa evaluate`).

constexpr int kRounds = 4;  // including the first, with the modes' own confidences
constexpr double kModeNoise_m = 0.03;
constexpr double kStrayDensity = 4;   // density of false modes, per cubic metre
constexpr double kMostTrust = 0.97;   // maximum of the sum over a target's modes; probability
constexpr double kLeastTrust = 1e-3;  // probability
constexpr double kContextRange = 4;   // nats below the likeliest context: skipped; no unit
constexpr double kApart_m = 0.08;     // modes nearer to the fused position are merged into it
constexpr double kMostMargin = 6;     // no unit: nats
constexpr double kMostDistance = 8;   // standard deviations

// An object's modes relative to their centre, in the form that all pose priors share.
struct Observed {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  std::vector<std::vector<Eigen::Vector3d>> position_m;  // target, mode
  std::vector<std::vector<double>> trust;                // prior trust in each mode
  std::vector<double> stray_trust;                       // trust in none being right
};

Observed Observe(const ForestModel& model, const TargetModes& modes) {
  Observed observed;
  double whole = 0;
  for (size_t t = 0; t < modes.size(); ++t) {
    std::vector<double> trust;
    double sum = 0;
    for (const Mode& mode : modes[t]) {
      const double p = Evaluate(model.targets()[t].correct, mode.feature);
      trust.push_back(std::clamp(p, kLeastTrust, kMostTrust));
      sum += trust.back();
    }
    const double scale = sum > kMostTrust ? kMostTrust / sum : 1.0;
    for (size_t m = 0; m < modes[t].size(); ++m) {
      trust[m] *= scale;
      observed.centre_m += trust[m] * modes[t][m].position_m.cast<double>();
      whole += trust[m];
    }
    observed.stray_trust.push_back(1.0 - scale * sum);
    observed.trust.push_back(std::move(trust));
  }
  if (whole > 0) observed.centre_m /= whole;
  for (const auto& list : modes) {
    observed.position_m.emplace_back();
    for (const Mode& mode : list) {
      observed.position_m.back().push_back(mode.position_m.cast<double>() - observed.centre_m);
    }
  }
  return observed;
}

Site MakeSite(const Observed& observed, size_t t, const std::vector<double>& weight,
              double model_variance) {
  Site site;
  double sum = 0;
  for (size_t m = 0; m < weight.size(); ++m) {
    sum += weight[m];
    site.mean_m += weight[m] * observed.position_m[t][m];
  }
  if (!(sum > 1e-6)) return Site();
  site.mean_m /= sum;
  site.variance_m2 = kModeNoise_m * kModeNoise_m / sum + model_variance;
  return site;
}

// Weights a target's modes by its prediction; returns the log-likelihood of the modes.
double Weigh(const Observed& observed, size_t t, TargetMarginal* marginal) {
  const Eigen::Matrix3d spread =
      marginal->covariance_m2 + kModeNoise_m * kModeNoise_m * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d inverse = spread.inverse();
  const double two_pi = 2.0 * std::numbers::pi;
  const double scale = 1.0 / std::sqrt(two_pi * two_pi * two_pi * spread.determinant());
  double whole = observed.stray_trust[t] * kStrayDensity;
  for (size_t m = 0; m < marginal->weight.size(); ++m) {
    const Eigen::Vector3d off = observed.position_m[t][m] - marginal->predicted_m;
    marginal->weight[m] = observed.trust[t][m] * scale * std::exp(-0.5 * off.dot(inverse * off));
    whole += marginal->weight[m];
  }
  for (double& weight : marginal->weight) weight /= whole;
  return std::log(whole);
}

// PoseMarginals under one prior; `log_likelihood` receives the fit of the modes.
std::vector<TargetMarginal> InferUnder(const FactorModel& model, const Observed& observed,
                                       double* log_likelihood) {
  std::vector<TargetMarginal> marginals(observed.trust.size());
  std::vector<Site> sites(marginals.size());
  for (size_t t = 0; t < marginals.size(); ++t) {
    marginals[t].weight = marginals[t].confidence = observed.trust[t];
  }
  for (int round = 0; round < kRounds; ++round) {
    for (size_t t = 0; t < marginals.size(); ++t) {
      sites[t] = MakeSite(observed, t, marginals[t].weight, model.variance_m2(t));
    }
    const std::vector<Prediction> predictions = model.Predict(sites);
    *log_likelihood = 0;
    for (size_t t = 0; t < marginals.size(); ++t) {
      static_cast<Prediction&>(marginals[t]) = predictions[t];
      *log_likelihood += Weigh(observed, t, &marginals[t]);
    }
  }
  return marginals;
}

float Logit(double p) {
  const double clipped = std::clamp(p, kLeastTrust, 1.0 - kLeastTrust);
  return static_cast<float>(std::log(clipped / (1.0 - clipped)));
}

// Features of the overall agreement of a person's targets.
void Summarise(const ForestModel& model, const TargetModes& modes, PoseMarginals* marginals) {
  const size_t targets = marginals->target.size();
  std::vector<double> trusted(targets, 0.0);
  for (size_t t = 0; t < targets; ++t) {
    const TargetMarginal& marginal = marginals->target[t];
    if (!modes[t].empty()) marginals->mean_confidence += marginal.confidence.front();
    marginals->mean_support += marginal.support();
    for (const double p : marginal.confidence) trusted[t] = std::max(trusted[t], p);
    trusted[t] *= marginal.support();
  }
  marginals->mean_confidence /= static_cast<double>(targets);
  marginals->mean_support /= static_cast<double>(targets);
  for (const std::vector<uint32_t>& near : model.tables().neighbours) {
    double sum = 0;
    for (const uint32_t t : near) sum += trusted[t];
    marginals->neighbour_support.push_back(near.empty() ? 0.0
                                                        : sum / static_cast<double>(near.size()));
  }
}

}  // namespace

double TargetMarginal::support() const {
  double sum = 0;
  for (const double w : weight) sum += w;
  return std::min(sum, 1.0);
}

PoseMarginals InferPose(const ForestModel& model, std::span<const float> context_posterior,
                        const TargetModes& modes) {
  const Observed observed = Observe(model, modes);
  const float top = *std::max_element(context_posterior.begin(), context_posterior.end());
  PoseMarginals best;
  double best_score = -1e300;
  double next_score = -1e300;
  for (size_t k = 0; k < context_posterior.size(); ++k) {
    const double log_prior = std::log(std::max(static_cast<double>(context_posterior[k]), 1e-6));
    if (log_prior < std::log(static_cast<double>(top)) - kContextRange) continue;
    double fit = 0;
    std::vector<TargetMarginal> marginals =
        InferUnder(model.tables().factor_models[k], observed, &fit);
    const double score = fit + log_prior;
    next_score = std::max(next_score, std::min(score, best_score));
    if (score <= best_score) continue;
    best_score = score;
    best.target = std::move(marginals);
  }
  for (TargetMarginal& marginal : best.target) marginal.predicted_m += observed.centre_m;
  best.margin = std::min(best_score - next_score, kMostMargin);
  Summarise(model, modes, &best);
  return best;
}

Eigen::Vector3d Fuse(const TargetMarginal& marginal, const std::vector<Mode>& modes,
                     double mode_noise_m) {
  Eigen::Matrix3d whole = marginal.covariance_m2.inverse();
  Eigen::Vector3d pull = whole * marginal.predicted_m;
  const size_t heaviest = static_cast<size_t>(
      std::max_element(marginal.weight.begin(), marginal.weight.end()) - marginal.weight.begin());
  for (size_t m = 0; m < modes.size(); ++m) {
    // Distant modes are alternatives and must not be averaged.
    if ((modes[m].position_m - modes[heaviest].position_m).norm() > kApart_m) continue;
    const double weight = marginal.weight[m] / (mode_noise_m * mode_noise_m);
    whole += weight * Eigen::Matrix3d::Identity();
    pull += weight * modes[m].position_m.cast<double>();
  }
  return whole.inverse() * pull;
}

namespace {

// Fills the features of the confidence model. `own`: confidence and weight of each candidate.
void AddFeatures(const PoseMarginals& marginals, size_t target_index,
                 const std::vector<std::array<double, 2>>& own,
                 std::vector<PlaceCandidate>& candidates) {
  const TargetMarginal& marginal = marginals.target[target_index];
  const Eigen::Matrix3d inverse =
      (marginal.covariance_m2 + kModeNoise_m * kModeNoise_m * Eigen::Matrix3d::Identity())
          .inverse();
  const double spread_m = std::sqrt(marginal.covariance_m2.trace() / 3.0);
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::Vector3d off = candidates[i].position_m - marginal.predicted_m;
    const double distance = std::min(std::sqrt(off.dot(inverse * off)), kMostDistance);
    candidates[i].feature = {Logit(own[i][0]),
                             static_cast<float>(own[i][1]),
                             static_cast<float>(distance),
                             static_cast<float>(std::log(spread_m)),
                             static_cast<float>(marginals.mean_confidence),
                             static_cast<float>(marginals.mean_support),
                             static_cast<float>(marginals.margin),
                             static_cast<float>(marginals.neighbour_support[target_index])};
  }
}

}  // namespace

std::vector<PlaceCandidate> Candidates(const ProposalTarget& target, const PoseMarginals& marginals,
                                       size_t target_index, const std::vector<Mode>& modes,
                                       const RefinedPlace* refined) {
  const TargetMarginal& marginal = marginals.target[target_index];
  std::vector<PlaceCandidate> candidates(1);
  candidates[0].is_fused = true;
  candidates[0].position_m = Fuse(marginal, modes, target.mode_noise_m);
  if (refined != nullptr) {
    candidates[0].position_m = refined->position_m;
    candidates[0].refined_confidence = refined->confidence;
  }
  std::vector<std::array<double, 2>> own = {{0.0, marginal.support()}};  // confidence, weight
  double heaviest = 0.05;  // threshold of a relevant mode
  for (size_t m = 0; m < modes.size(); ++m) {
    own[0][0] += marginal.weight[m] * marginal.confidence[m] / std::max(marginal.support(), 1e-6);
    if (marginal.weight[m] > heaviest) {
      heaviest = marginal.weight[m];
      candidates[0].mode = static_cast<int>(m);
    }
    const Eigen::Vector3d position_m = modes[m].position_m.cast<double>();
    if ((position_m - candidates[0].position_m).norm() <= kApart_m) continue;
    candidates.push_back({position_m, {}, false, static_cast<int>(m), {}});
    own.push_back({marginal.confidence[m], marginal.weight[m]});
  }
  AddFeatures(marginals, target_index, own, candidates);
  return candidates;
}

double ComputeConfidence(const ProposalTarget& target, const PlaceCandidate& candidate) {
  if (candidate.refined_confidence) return *candidate.refined_confidence;
  return Evaluate(candidate.is_fused ? target.fused : target.apart, candidate.feature);
}

}  // namespace ossa::forest
