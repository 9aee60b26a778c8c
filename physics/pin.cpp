#include <algorithm>
#include <cmath>

#include "physics/actor_internal.h"

namespace ossa::physics {

using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

// Constants: chosen by hand at authored motion and UI-PRMD (`ossa experiment shum-ho-2012`, parts =
// ["filter"]).

constexpr double kReach_m = 0.02;  // force limit of a pin: stiffness x reach
constexpr double kFootStiffness_n_m = 1e6;
/// Effective mass at a pin: a leg. Only sets the damping, 2 sqrt(k m).
constexpr double kPinnedMass_kg = 8.0;

// When a foot stands: near the floor and slower than a swinging foot (2-4 m/s, at least 0.3 m/s
// just before landing), for long enough to be robust to noise. Kinect foot joints are up to 5 cm
// above the sole. Departure: the paper fixes a foot while its target touches the floor, which a
// sensor's jittering foot does in single frames, or never.
constexpr double kStandHeight_m = 0.05, kLiftHeight_m = 0.08;
constexpr double kStillSpeed_m_s = 0.15, kStillTime_s = 0.12;
constexpr double kSmoothing_s = 0.08;
// When it has left: the target is this far from the pin for this time, or twice as far at once.
constexpr double kAway_m = 0.04, kAwayTime_s = 0.06;
// A foot that comes to rest slightly beside its pin is pinned again there.
constexpr double kBeside_m = 0.012, kBesideTime_s = 0.25;

/// The thresholds above, adapted to the target's noise. A noisy target is averaged for longer and
/// may deviate more; factors by a sweep on noisy mocap.
struct Thresholds {
  explicit Thresholds(double noise_m) {
    constexpr double kClean_m = 0.004;
    const double excess_m = std::max(0.0, noise_m - kClean_m);
    smoothing_s = kSmoothing_s + 10.0 * excess_m;
    still_m_s = kStillSpeed_m_s + 5.0 * excess_m;
    stand_m = kStandHeight_m + 1.0 * excess_m;
    lift_m = kLiftHeight_m + 2.0 * excess_m;
    away_m = kAway_m + 4.0 * excess_m;
    beside_m = kBeside_m + 2.0 * excess_m;
  }
  double smoothing_s, still_m_s, stand_m, lift_m, away_m, beside_m;
};

}  // namespace

Pin::Pin(OdeWorld& ode, Character& character, size_t joint, const Anchor& anchor,
         double stiffness_n_m)
    : character_(character),
      joint_(joint),
      anchor_(anchor),
      stiffness_n_m_(stiffness_n_m),
      made_(ode.made++) {
  ball_ = dJointCreateBall(ode.world, nullptr);
  dJointAttach(ball_, character.body(character.BodyOfJoint(joint)), anchor.body);
}

Pin::~Pin() { dJointDestroy(ball_); }

void Pin::Update(double h_s) {
  const Vector3d now = character_.JointPosition(joint_);
  dJointSetBallAnchor(ball_, now.x(), now.y(), now.z());
  Vector3d pull = anchor_.Now() - now;
  if (pull.norm() > kReach_m) pull *= kReach_m / pull.norm();
  // ODE takes the second anchor in the other body's frame.
  const Vector3d anchor = anchor_.body == nullptr ? Vector3d(now + pull)
                                                  : PoseOf(anchor_.body).inverse() * (now + pull);
  dJointSetBallAnchor2(ball_, anchor.x(), anchor.y(), anchor.z());
  const auto soft =
      SpringDamper(stiffness_n_m_, 2.0 * std::sqrt(stiffness_n_m_ * kPinnedMass_kg), h_s);
  dJointSetBallParam(ball_, dParamERP, soft.erp);
  dJointSetBallParam(ball_, dParamCFM, soft.cfm);
}

void FootPin::Clear() {
  pin_.reset();
  memory = {};
}

void FootPin::Restore(OdeWorld& ode, Character& character, const std::optional<Vector3d>& place_m) {
  pin_ = place_m
             ? std::make_unique<Pin>(ode, character, joint_, Anchor{*place_m}, kFootStiffness_n_m)
             : nullptr;
}

/// Standard deviation of the target's noise per axis, from second differences: for white noise
/// their mean square is 6 x 3 sigma^2; the motion of a standing foot does not contribute.
void FootPin::EstimateNoise(const Vector3d& target_m, double dt_s) {
  constexpr double kMemory_s = 0.5, kMost_m = 0.05;
  if (memory.last_m.size() == 2) {
    const double second_m = (target_m - 2.0 * memory.last_m[1] + memory.last_m[0]).norm();
    const double share = 1.0 - std::exp(-dt_s / kMemory_s);
    memory.noise_m += share * (std::min(second_m / std::sqrt(18.0), kMost_m) - memory.noise_m);
    memory.last_m.erase(memory.last_m.begin());
  }
  memory.last_m.push_back(target_m);
}

void FootPin::Update(OdeWorld& ode, Character& character, const std::optional<Vector4d>& floor,
                     const Vector3d& target_m, double dt_s) {
  if (!floor) {
    Clear();
    return;
  }
  EstimateNoise(target_m, dt_s);
  const Thresholds limit(memory.noise_m);
  const Vector3d before = memory.smooth_m.value_or(target_m);
  const double share = 1.0 - std::exp(-dt_s / limit.smoothing_s);
  memory.smooth_m = before + share * (target_m - before);
  const double speed = (*memory.smooth_m - before).norm() / dt_s;
  const double sole_m = character.segments()[joint_].radius_m;
  const double height = HeightAbove(*floor, *memory.smooth_m) - sole_m;
  if (pin_ == nullptr) {
    const bool still = height < limit.stand_m && speed < limit.still_m_s;
    memory.still_s = still ? memory.still_s + dt_s : 0.0;
    if (memory.still_s < kStillTime_s) return;
    Vector3d place = character.JointPosition(joint_);
    const double below = sole_m - HeightAbove(*floor, place);
    if (below > 0.0) place += below * floor->head<3>();
    pin_ = std::make_unique<Pin>(ode, character, joint_, Anchor{place}, kFootStiffness_n_m);
    memory.away_s = memory.beside_s = 0.0;
    return;
  }
  const double distance = (target_m - pin_->place_m()).norm();
  memory.away_s = distance > limit.away_m ? memory.away_s + dt_s : 0.0;
  const bool beside = (*memory.smooth_m - pin_->place_m()).norm() > limit.beside_m;
  memory.beside_s = beside ? memory.beside_s + dt_s : 0.0;
  if (height > limit.lift_m || memory.away_s > kAwayTime_s || distance > 2.0 * limit.away_m ||
      memory.beside_s > kBesideTime_s) {
    pin_.reset();
    memory.still_s = 0.0;
  }
}

}  // namespace ossa::physics
