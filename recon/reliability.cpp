// H. P. H. Shum, E. S. L. Ho, Y. Jiang, S. Takagi, Real-Time Posture Reconstruction for Microsoft
// Kinect, IEEE Trans. Cybernetics 2013, section IV.
#include "recon/reliability.h"

#include <algorithm>
#include <cmath>

#include "depth/image/camera.h"
#include "recon/placed_joint.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

/// Angle in degrees between a bone and the vertical, pointing up.
double TiltFromUp(const Posture& posture, Joint from, Joint to) {
  return AngleBetween_rad(posture[to] - posture[from], Eigen::Vector3d::UnitY()) * 180.0 / M_PI;
}

}  // namespace

bool IsReferencePosture(const Posture& p, const ReferenceLengthOptions& options) {
  constexpr double kLevel_deg = 90.0;  // definition
  const double upright_deg = options.upright_deg, arms_deg = options.level_arms_deg;
  // Negated comparisons, so that NaN is not upright.
  if (!(TiltFromUp(p, Joint::kHipCenter, Joint::kShoulderCenter) <= upright_deg)) return false;
  for (const auto& [hip, shoulder] : {std::pair{Joint::kHipLeft, Joint::kShoulderLeft},
                                      std::pair{Joint::kHipRight, Joint::kShoulderRight}}) {
    const auto next = [](Joint j, size_t n) { return static_cast<Joint>(Index(j) + n); };
    if (!(TiltFromUp(p, next(hip, 1), hip) <= upright_deg)) return false;
    if (!(TiltFromUp(p, next(hip, 2), next(hip, 1)) <= upright_deg)) return false;
    const double upper = TiltFromUp(p, shoulder, next(shoulder, 1));
    const double lower = TiltFromUp(p, next(shoulder, 1), next(shoulder, 2));
    const bool level =
        std::abs(upper - kLevel_deg) < arms_deg && std::abs(lower - kLevel_deg) < arms_deg;
    const bool hanging = upper > options.hanging_upper_deg && lower > options.hanging_lower_deg;
    if (!level && !hanging) return false;
  }
  return true;
}

void ReferenceLengths::Observe(const Posture& in_camera, const JointWeights& trust) {
  const BoneLengths lengths = MeasureBoneLengths(in_camera);
  // "All body parts tracked" means all that this sensor provides: UI-PRMD's Kinect has no hands.
  int known_joints = 0;
  bool all = true;
  for (size_t i = 0; i < kJointCount; ++i) {
    had_[i] = had_[i] || trust[i] >= options_.tracked;
    known_joints += had_[i] ? 1 : 0;
    all = all && (!had_[i] || trust[i] >= options_.tracked);
  }
  if (all && known_joints >= options_.fewest_joints && IsReferencePosture(in_camera, options_)) {
    FromReferencePosture(lengths, trust);
  } else if (!from_posture_) {
    FromAnyPosture(lengths, trust);
  }
}

void ReferenceLengths::FromReferencePosture(const BoneLengths& lengths, const JointWeights& trust) {
  // Departure: the paper uses the lengths of every reference posture. A length that is implausible
  // for a body of this size is an error of the frame, not a property of the person; so is one far
  // from an earlier reference posture's while the size is unchanged. Lengths are averaged over some
  // ten reference postures of a person.
  const double scale = EstimateBodyScale(lengths, trust);
  const bool same_size = from_posture_ && std::abs(scale / scale_ - 1.0) < options_.other_size;
  for (size_t i = 1; i < kJointCount; ++i) {
    const double standard = scale * StandardBoneLengths()[i];
    if (std::min(trust[i], trust[ParentOf(i)]) < options_.tracked) {
      if (!same_size) of_reference_.Start(i, standard);
    } else if (!same_size) {
      of_reference_.Start(
          i, std::clamp(lengths[i], options_.shortest * standard, options_.longest * standard));
    } else if (std::abs(lengths[i] / of_reference_.length_m(i) - 1.0) < options_.other_length) {
      of_reference_.Add(i, lengths[i]);
    }
  }
  scale_ = scale;
  known_ = from_posture_ = true;
}

/// Departure: before any reference posture, which the paper does not consider: the standard body at
/// the person's size, except that midline, hands and feet are the mean of the observations so far.
/// Sensors place the spine differently but consistently (a Kinect v2's is 10 cm higher, which would
/// make HipCenter half unreliable forever), and each defines hands and feet in its own way (a
/// Kinect v2's hand is twice as far from the wrist); for the other joints the reverse holds.
void ReferenceLengths::FromAnyPosture(const BoneLengths& lengths, const JointWeights& trust) {
  const auto seen =
      std::count_if(trust.begin(), trust.end(), [this](double t) { return t > options_.present; });
  if (seen < options_.fewest_joints) return;
  if (!known_) scale_ = EstimateBodyScale(lengths, trust);
  known_ = true;
  for (size_t i = 1; i < kJointCount; ++i) {
    const double standard = scale_ * StandardBoneLengths()[i];
    if (before_reference_.measurements(i) == 0) before_reference_.Start(i, standard);
    const bool midline = i <= 3, hand_or_foot = !midline && i % 4 == 3;
    if (!midline && !hand_or_foot) continue;
    const double both = std::min(trust[i], trust[ParentOf(i)]);
    if (both <= options_.present || !std::isfinite(lengths[i])) continue;
    before_reference_.Add(
        i, std::clamp(lengths[i], options_.shortest * standard, options_.longest * standard));
  }
}

Reliability ReliabilityEstimator::Step(
    const TrackedPosture& observed, const depth::DepthFrame* depth, double dt_s,
    const std::optional<Eigen::Isometry3d>& camera_from_observed) {
  Reliability r;
  JointWeights seen{};
  for (size_t i = 0; i < kJointCount; ++i) {
    const bool possible = IsPossiblePlace(observed.posture.position_m[i]);
    const bool tracked = observed.state[i] == TrackingState::kTracked;
    const bool present = observed.state[i] != TrackingState::kNotTracked;
    seen[i] = possible && present ? 1.0 : 0.0;
    r.state[i] = possible && (tracked || (!options_.use_state && present)) ? 1.0 : 0.0;  // eq. 7
  }
  postures_.push_back(observed.posture);
  seen_.push_back(seen);
  const auto keep = static_cast<size_t>(options_.behaviour_frames) + 2;
  if (postures_.size() > keep) postures_.pop_front();
  if (seen_.size() > keep) seen_.pop_front();

  r.surface.fill(1.0);
  if (options_.use_depth && depth != nullptr) {
    Posture in_camera = observed.posture;
    if (camera_from_observed) {
      for (auto& p : in_camera.position_m) p = *camera_from_observed * p;
    }
    r.surface = SurfaceReliability(in_camera, *depth, options_);
  }
  reference_.Observe(observed.posture, r.state);
  r.behaviour = Behaviour();
  r.kinematics = Kinematics(observed.posture, seen);
  r.speed.fill(1.0);
  if (options_.use_speed) r.speed = speed_.Step(observed.posture, seen, dt_s, options_);
  for (size_t i = 0; i < kJointCount; ++i) {
    r.instant[i] =
        std::min({r.behaviour[i], r.kinematics[i], r.state[i], r.surface[i], r.speed[i]});
  }
  instant_.push_back(r.instant);
  if (instant_.size() > static_cast<size_t>(options_.window_frames)) instant_.pop_front();
  r.rate = Smoothed();
  return r;
}

void ReliabilityEstimator::Reset() { *this = ReliabilityEstimator(options_); }

void ReliabilityEstimator::ForgetMotion() {
  postures_.clear();
  seen_.clear();
  instant_.clear();
  speed_ = SpeedTerm();
}

// Eqs. 1-4. Departure: eq. 3 prints the cosine where the text and the limits in degrees of eq. 4
// mean the angle; the angle is used. The sums of eqs. 4 and 8 are over f_b and f_total terms: their
// printed limits, from 0 to f_b, would average four angles with a divisor of three.
JointWeights ReliabilityEstimator::Behaviour() const {
  JointWeights rb;
  rb.fill(1.0);
  const int angles = static_cast<int>(postures_.size()) - 2;
  if (!options_.use_behaviour || angles < 1) return rb;
  for (size_t i = 0; i < kJointCount; ++i) {
    double sum = 0.0;
    for (int f = 0; f < angles; ++f) {
      const auto k = static_cast<size_t>(f);
      if (seen_[k][i] * seen_[k + 1][i] * seen_[k + 2][i] == 0.0) continue;
      const Eigen::Vector3d d0 = postures_[k + 1].position_m[i] - postures_[k].position_m[i];
      const Eigen::Vector3d d1 = postures_[k + 2].position_m[i] - postures_[k + 1].position_m[i];
      if (d0.norm() > options_.d_min_m && d1.norm() > options_.d_min_m)
        sum += AngleBetween_rad(d0, d1);
    }
    const double mean = sum / options_.behaviour_frames;
    const double over = std::max(std::min(mean, options_.roof_rad) - options_.floor_rad, 0.0);
    rb[i] = 1.0 - over / (options_.roof_rad - options_.floor_rad);  // eq. 4
  }
  return rb;
}

// Eqs. 5-6, over bones with both ends present.
JointWeights ReliabilityEstimator::Kinematics(const Posture& posture,
                                              const JointWeights& seen) const {
  JointWeights rk;
  rk.fill(1.0);
  if (!options_.use_kinematics || !reference_.known()) return rk;
  JointWeights sum{}, count{};
  const BoneLengths lengths = MeasureBoneLengths(posture);
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    if (seen[i] * seen[parent] == 0.0) continue;
    const double reference = std::max(reference_.length_m(i), 1e-3);
    const double d = std::min(std::abs(lengths[i] - reference) / reference, 1.0);  // eq. 5
    for (const size_t end : {i, parent}) {
      sum[end] += d;
      count[end] += 1.0;
    }
  }
  for (size_t i = 0; i < kJointCount; ++i) {
    if (count[i] > 0.0) rk[i] = 1.0 - sum[i] / count[i];  // eq. 6
  }
  return rk;
}

// Eq. 8. Departure: the Gaussian weights are divided by their sum, so that R stays in [0, 1].
JointWeights ReliabilityEstimator::Smoothed() const {
  JointWeights rate{};
  double total = 0.0;
  for (size_t f = 0; f < instant_.size(); ++f) {
    const double age = static_cast<double>(instant_.size() - 1 - f);
    const double w = std::exp(-0.5 * std::pow(age / options_.window_sigma_frames, 2.0));
    total += w;
    for (size_t i = 0; i < kJointCount; ++i) rate[i] += w * instant_[f][i];
  }
  for (double& r : rate) r = std::clamp(r / total, 0.0, 1.0);
  return rate;
}

JointWeights SurfaceReliability(const Posture& in_camera, const depth::DepthFrame& depth,
                                const ReliabilityOptions& options) {
  JointWeights surface;
  surface.fill(1.0);
  const depth::DepthView view = depth.view();
  for (size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d& p = in_camera.position_m[i];
    if (!p.allFinite() || p.z() < 0.1) continue;
    const Eigen::Vector2d at = depth::Project(depth.camera, p);
    // The joint's radius in the image: a hand may be a few pixels beside its blob.
    const double radius = std::clamp(0.04 * depth.camera.fx / p.z(), 1.0, 12.0);
    if (!(std::abs(at.x()) < 1e5 && std::abs(at.y()) < 1e5)) continue;
    double nearest_gap_m = 1e9;  // surface minus joint along z, the one that fits the joint best
    bool read = false;
    for (const auto& [du, dv] : {std::pair{0.0, 0.0}, std::pair{-1.0, 0.0}, std::pair{1.0, 0.0},
                                 std::pair{0.0, -1.0}, std::pair{0.0, 1.0}}) {
      const int u = static_cast<int>(std::lround(at.x() + du * radius));
      const int v = static_cast<int>(std::lround(at.y() + dv * radius));
      if (!view.Contains(u, v) || view.at(u, v) == 0) continue;
      read = true;
      const double gap = depth::MetresFromMillimetres(view.at(u, v)) - p.z();
      if (std::abs(gap) < std::abs(nearest_gap_m)) nearest_gap_m = gap;
    }
    if (!read) continue;
    if (nearest_gap_m < -options.surface_behind_m || nearest_gap_m > options.surface_before_m) {
      surface[i] = 0.0;
    }
  }
  return surface;
}

}  // namespace ossa::recon
