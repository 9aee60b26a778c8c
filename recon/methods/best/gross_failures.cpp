#include "recon/methods/best/gross_failures_internal.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "depth/base/statistics.h"

namespace ossa::recon {
namespace {

bool Seen(const TrackedPosture& observed, size_t i) {
  return observed.state[i] != TrackingState::kNotTracked &&
         observed.posture.position_m[i].allFinite();
}

/// Median distance between observed and expected joints; none if few are observed.
std::optional<double> MedianDistance(const TrackedPosture& observed, const Posture& expected) {
  std::vector<double> d;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (Seen(observed, i)) {
      d.push_back((observed.posture.position_m[i] - expected.position_m[i]).norm());
    }
  }
  if (d.size() < 4) return std::nullopt;
  return Median(std::move(d));
}

}  // namespace

double GrossFailures::Repair(ReconstructionInput& input) {
  joint_trust_.fill(1.0);
  elsewhere_ = false;
  failure_ = GrossFailure::kNone;
  const std::optional<double> step = steps_.To(input.time_s);
  if (!last_ || !step) return Restart();
  const double step_s = *step;
  const Posture predicted = Predict(step_s);
  const std::optional<double> distance_m = MedianDistance(input.observed, predicted);
  const TrackedPosture exchanged = SidesExchanged(input.observed);
  const auto exchanged_distance_m = MedianDistance(exchanged, predicted);
  const bool sides = distance_m && exchanged_distance_m && *distance_m > options_.slack_m &&
                     *exchanged_distance_m < options_.mirrored_ratio * *distance_m;
  exchanged_s_ = sides ? exchanged_s_ + step_s : 0.0;
  if (exchanged_s_ > options_.sides_patience_s) return AcceptPersistentFailure();
  if (!sides && distance_m && IsBeyondReach(*distance_m, step_s)) {
    body_jumped_s_ += step_s;
    const bool is_own = SameBones(input.observed);
    const double patience_s = is_own ? options_.own_patience_s : options_.patience_s;
    if (body_jumped_s_ >= patience_s) return AcceptPersistentFailure();
    failure_ = GrossFailure::kAnotherBody;
    return 0.0;
  }
  if (sides) {
    input.observed = exchanged;
    failure_ = GrossFailure::kSidesExchanged;
  }
  body_jumped_s_ = 0.0;
  const auto moved_m = MedianDistance(input.observed, *last_);
  elsewhere_ = moved_m && *moved_m > options_.cut_speed * std::max(step_s, 1.0 / 30.0);
  JudgeJoints(input.observed, predicted, step_s);
  return sides ? 0.5 : 1.0;
}

double GrossFailures::Restart() {
  last_.reset();
  before_last_.reset();
  jumped_s_.fill(0.0);
  body_jumped_s_ = exchanged_s_ = 0.0;
  return 1.0;
}

Posture GrossFailures::Predict(double step_s) const {
  Posture predicted = *last_;
  if (!before_last_) return predicted;
  // Half the velocity: with all of it every change of direction would look like a jump.
  const double share = 0.5 * step_s / last_dt_s_;
  for (size_t i = 0; i < kJointCount; ++i) {
    predicted.position_m[i] += share * (last_->position_m[i] - before_last_->position_m[i]);
  }
  return predicted;
}

bool GrossFailures::IsBeyondReach(double distance_m, double step_s) const {
  return distance_m > options_.slack_m + options_.body_slack_m + options_.body_speed * step_s;
}

/// Accepts a persistent failure: the past was wrong, or is over.
double GrossFailures::AcceptPersistentFailure() {
  elsewhere_ = true;
  last_.reset();
  before_last_.reset();
  body_jumped_s_ = exchanged_s_ = 0.0;
  return 0.5;
}

void GrossFailures::JudgeJoints(const TrackedPosture& observed, const Posture& predicted,
                                double dt_s) {
  for (size_t i = 0; i < kJointCount; ++i) {
    if (!Seen(observed, i)) {
      jumped_s_[i] = 0.0;
      continue;
    }
    const Eigen::Vector3d& p = observed.posture.position_m[i];
    const double allowed = options_.slack_m + options_.limb_speed * std::min(dt_s, 0.1) * 0.5;
    if ((p - predicted.position_m[i]).norm() <= allowed) {
      jumped_s_[i] = 0.0;
      continue;
    }
    // A joint that keeps jumping between wrong places does not stay.
    const bool stays = jumped_s_[i] > 0.0 && (p - suspect_.position_m[i]).norm() < allowed;
    jumped_s_[i] = stays ? jumped_s_[i] + dt_s : dt_s;
    suspect_.position_m[i] = p;
    // A jump without further signs of an error is a fast movement or a lost frame.
    if (jumped_s_[i] < options_.patience_s && LooksWrong(observed, i))
      joint_trust_[i] = options_.jump_trust;
  }
}

/// Whether the observed bones are the person's: half of them within a tenth.
bool GrossFailures::SameBones(const TrackedPosture& observed) const {
  const BoneLengths now = MeasureBoneLengths(observed.posture), before = MeasureBoneLengths(*last_);
  std::vector<double> off;
  for (size_t i = 1; i < kJointCount; ++i) {
    if (!Seen(observed, i) || !Seen(observed, ParentOf(i))) continue;
    off.push_back(std::abs(now[i] / before[i] - 1.0));
  }
  if (off.size() < 6) return false;
  return Median(std::move(off)) < options_.same_bone;
}

/// Further evidence against a joint that jumped: a wrong bone length, or it coincides with its
/// counterpart of the other side where it did not before.
bool GrossFailures::LooksWrong(const TrackedPosture& observed, size_t i) const {
  const auto m = kMirroredJoint[i];
  const auto distance = [](const Posture& p, size_t a, size_t b) {
    return (p.position_m[a] - p.position_m[b]).norm();
  };
  if (m != i && Seen(observed, m) && distance(observed.posture, i, m) < options_.same_place_m &&
      distance(*last_, i, m) > 2.0 * options_.same_place_m) {
    return true;
  }
  if (i == 0) return false;
  const auto parent = ParentOf(i);
  if (!Seen(observed, parent)) return false;
  const double before = distance(*last_, i, parent);
  return std::abs(distance(observed.posture, i, parent) - before) > options_.wrong_bone * before;
}

void GrossFailures::Remember(const Posture& made, double dt_s) {
  before_last_ = last_;
  last_ = made;
  last_dt_s_ = dt_s;
}

}  // namespace ossa::recon
