#include "recon/models/prior_filter.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace ossa::recon {
namespace {

/// A joint's position as a linear function of the modes u: position = at_m + of_modes * u, plus a
/// residual variance.
struct JointModel {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic> of_modes;
  Eigen::Vector3d residual_m2 = Eigen::Vector3d::Zero();
};

/// Scales each bone to the person's length; parents before children.
JointArray<JointModel> MakeJointModels(const PosturePrior& prior, const BoneLengths& lengths_m) {
  JointArray<JointModel> models;
  models[0].of_modes.setZero(3, prior.modes_m.cols());
  for (size_t i = 1; i < kJointCount; ++i) {
    const JointModel& parent = models[ParentOf(i)];
    const double ratio = lengths_m[i] / StandardBoneLengths()[i];
    const auto row = FirstCoordinate(i - 1);
    models[i].at_m = parent.at_m + ratio * prior.mean_m.segment<3>(row);
    models[i].of_modes = parent.of_modes + ratio * prior.modes_m.middleRows<3>(row);
    models[i].residual_m2 = parent.residual_m2 + ratio * ratio * prior.residual_m2.segment<3>(row);
  }
  return models;
}

bool IsSeen(const PriorObservation& observation, size_t joint) {
  return observation.sd_m[joint] > 0.0 && observation.seen.position_m[joint].allFinite();
}

/// Sum of a person's bone lengths except the root's, > 0.
double Sum(const BoneLengths& lengths_m) {
  return std::accumulate(lengths_m.begin() + 1, lengths_m.end(), 0.0);
}

}  // namespace

double BaseSigma_m(double share_of_guesses) {
  // Best two of 0, 0.2, 0.5 and 1 on ten scenarios of Plantard 2016 with motion of validation
  // subjects.
  constexpr double kAmongGuesses_m = 0.5;
  return 0.02 + kAmongGuesses_m * share_of_guesses;
}

PriorFilter::PriorFilter(std::shared_ptr<const PosturePrior> prior) : prior_(std::move(prior)) {
  Reset();
}

void PriorFilter::Reset() {
  const Eigen::Index modes = prior_->correlation_time_s.size();
  last_ = PriorObservation();
  last_.lengths_m = StandardBoneLengths();
  network_share_.reset();
  mean_ = Eigen::VectorXd::Zero(modes + 3);
  covariance_ = Eigen::MatrixXd::Identity(modes + 3, modes + 3);
}

/// Each mode decays with its own time constant; the root's position is not propagated.
void PriorFilter::Predict(double dt_s, double root_sd_m) {
  const Eigen::Index modes = prior_->correlation_time_s.size();
  Eigen::VectorXd kept = Eigen::VectorXd::Zero(modes + 3);
  kept.head(modes) = (-dt_s / prior_->correlation_time_s.array()).exp();
  mean_ = mean_.cwiseProduct(kept);
  covariance_ = kept.asDiagonal() * covariance_ * kept.asDiagonal();
  covariance_.diagonal().head(modes).array() += 1.0 - kept.head(modes).array().square();
  covariance_.diagonal().tail<3>().setConstant(root_sd_m * root_sd_m);
}

/// Fades in and out: the posture must not jump when guesses appear or disappear.
double PriorFilter::NetworkShare(double dt_s) {
  constexpr double kFade_s = 0.25;  // by hand
  const double wanted = last_.guesses ? 0.0 : 1.0;
  if (!(dt_s > 0.0)) return network_share_.value_or(wanted);
  const double before = network_share_.value_or(wanted);
  network_share_ = wanted + (before - wanted) * std::exp(-dt_s / kFade_s);
  return *network_share_;
}

Posture PriorFilter::Step(double dt_s, const PriorObservation& observation) {
  Predict(dt_s, observation.root_sd_m);
  const Eigen::Index modes = prior_->correlation_time_s.size();
  const auto models = MakeJointModels(*prior_, observation.lengths_m);
  Eigen::Matrix<double, 3, Eigen::Dynamic> h(3, modes + 3);
  h.rightCols<3>().setIdentity();
  for (size_t i = 1; i < kJointCount; ++i) {
    if (!IsSeen(observation, i)) continue;
    const double sd_m = observation.sd_m[i];
    h.leftCols(modes) = models[i].of_modes;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> spread = covariance_ * h.transpose();
    Eigen::Matrix3d innovation = h * spread;
    innovation.diagonal() += models[i].residual_m2;
    innovation.diagonal().array() += sd_m * sd_m;
    const Eigen::Matrix<double, Eigen::Dynamic, 3> gain = spread * innovation.inverse();
    mean_ += gain * (observation.seen.position_m[i] - models[i].at_m - h * mean_);
    covariance_ -= gain * spread.transpose();
  }
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  last_ = observation;
  BoneVector bones_m = Bones_m();
  const double share = NetworkShare(dt_s);
  if (!prior_->network.empty()) bones_m += share * prior_->network.Correction_m(Input());
  Posture out = Retargeted(PostureFromBones(bones_m), observation.lengths_m);
  for (Eigen::Vector3d& p : out.position_m) p += mean_.tail<3>();
  return out;
}

BoneVector PriorFilter::Bones_m() const {
  return prior_->mean_m + prior_->modes_m * mean_.head(prior_->correlation_time_s.size());
}

PriorInput PriorFilter::Input() const {
  const auto models = MakeJointModels(*prior_, last_.lengths_m);
  const Eigen::VectorXd modes = mean_.head(prior_->correlation_time_s.size());
  const double standard_from_person = Sum(StandardBoneLengths()) / Sum(last_.lengths_m);
  PriorInput input;
  input.head<kBoneDims>() = Bones_m().cast<float>();
  auto clear = input.segment<kJointCount - 1>(kBoneDims);
  auto seen_m = input.tail<kBoneDims>();
  clear.setZero();
  seen_m.setZero();
  for (size_t i = 1; i < kJointCount; ++i) {
    if (!IsSeen(last_, i)) continue;
    const auto at = static_cast<Eigen::Index>(i - 1);
    clear[at] = ObservationQuality(last_.sd_m[i]);
    const Eigen::Vector3d expected_m =
        models[i].at_m + models[i].of_modes * modes + mean_.tail<3>();
    seen_m.segment<3>(3 * at) =
        (standard_from_person * (last_.seen.position_m[i] - expected_m)).cast<float>();
  }
  return input;
}

double PriorFilter::Uncertainty_m(Joint joint) const {
  const Eigen::Index modes = prior_->correlation_time_s.size();
  const auto models = MakeJointModels(*prior_, StandardBoneLengths());
  const JointModel& model = models[joint];
  const Eigen::Matrix3d spread =
      model.of_modes * covariance_.topLeftCorner(modes, modes) * model.of_modes.transpose();
  return std::sqrt(std::max(0.0, spread.trace() + model.residual_m2.sum()));
}

}  // namespace ossa::recon
