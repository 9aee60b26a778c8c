#pragma once
#include <map>
#include <memory>
#include <span>

#include "physics/character_internal.h"
#include "physics/joint_limits_internal.h"
#include "physics/world.h"

namespace ossa::physics {

/// A pin between the end of a bone and a point of the world or of an object: a ball joint with the
/// compliance of a stiff spring, so that contradictory targets bend it instead of tearing the
/// character apart.
class Pin {
 public:
  Pin(OdeWorld& ode, Character& character, size_t joint, const Anchor& anchor,
      double stiffness_n_m);
  ~Pin();
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

  /// Before each substep: the anchor is at most `kReach_m` from the joint, which bounds the force.
  void Update(double h_s);
  Eigen::Vector3d place_m() const { return anchor_.Now(); }
  const Anchor& anchor() const { return anchor_; }
  uint64_t made() const { return made_; }

 private:
  Character& character_;
  size_t joint_;
  Anchor anchor_;
  double stiffness_n_m_;
  dJointID ball_;
  uint64_t made_;  // OdeWorld::made
};

/// State of a foot's pin between frames.
struct FootPinMemory {
  std::optional<Eigen::Vector3d> smooth_m;  // the smoothed target
  std::vector<Eigen::Vector3d> last_m;      // the last two targets
  double noise_m = 0.0;                     // standard deviation of the target, per axis
  double still_s = 0.0;                     // time since the target last moved
  double away_s = 0.0;                      // time since it left the pin
  double beside_s = 0.0;                    // time it has rested slightly beside the pin
};

/// Decides when a foot carries the body, from where its target goes (Shum & Ho 2012, sec. 6.1).
class FootPin {
 public:
  explicit FootPin(size_t joint) : joint_(joint) {}
  void Update(OdeWorld& ode, Character& character, const std::optional<Eigen::Vector4d>& floor,
              const Eigen::Vector3d& target_m, double dt_s);
  void Clear();
  /// Restores the state, including its pin if it had one.
  void Restore(OdeWorld& ode, Character& character, const std::optional<Eigen::Vector3d>& place_m);
  Pin* pin() { return pin_.get(); }
  const Pin* pin() const { return pin_.get(); }
  size_t joint() const { return joint_; }
  FootPinMemory memory;

 private:
  void EstimateNoise(const Eigen::Vector3d& target_m, double dt_s);

  size_t joint_;
  std::unique_ptr<Pin> pin_;
};

/// A character's targets and state between frames.
struct ActorMemory {
  bool controlled = true;
  recon::Posture wanted;                                       // target of SetTarget, made finite
  std::optional<recon::JointOrientations> wanted_orientation;  // none: derived from the joints
  recon::JointArray<double> weight{};
  recon::Posture aim, last_aim;                          // with bone lengths, above the floor
  recon::JointArray<Eigen::Vector3d> mean_velocity_m_s;  // of `aim`, see Lead
  recon::JointArray<double> mean_speed_m_s{};
  recon::JointArray<Eigen::Vector3d> aim_velocity_m_s;
  recon::JointOrientations aim_orientation;
  ControlTarget control;
  std::vector<std::pair<size_t, Eigen::Vector3d>> pushes;  // impulses for the next substep
  std::vector<std::pair<size_t, Eigen::Vector3d>> pulls;   // forces for the next step
  double max_gap_m = 0.0;     // between anchors, before Reconnect, since the frame began
  int rescued = 0;            // number of rescues from non-finite motion
  double dodge_left_s = 0.0;  // time that raised arms stay up after the threat has passed
  double lean_left_s = 0.0;   // time that the lean is kept
  Eigen::Vector3d escape = Eigen::Vector3d::Zero();    // direction of the lean, a unit vector
  Eigen::Vector3d lean_rad = Eigen::Vector3d::Zero();  // current lean as a rotation vector
};

/// A character with its targets and constraints.
struct Actor : ActorMemory {
  Actor(OdeWorld& ode, const recon::BoneLengths& lengths, const CharacterOptions& options, int tag);

  void Forget();  // resets motion and trust
  void Place(const recon::Posture& posture, const std::optional<Eigen::Vector4d>& floor);
  void SetTarget(const recon::Posture& target, std::span<const double> weight,
                 const std::optional<recon::JointOrientations>& orientation);
  /// Decides whether to lean, and in which direction, to avoid a flying object: once per frame and
  /// object.
  void WatchFor(const ObjectState& thing, double radius_m, const Eigen::Vector3d& gravity_m_s2);
  /// Once per frame: floor, feet, constraints; sets `from`, `aim` and the stiffness.
  void Prepare(OdeWorld& ode, const std::optional<Eigen::Vector4d>& floor, double dt_s);
  /// Once per substep, `left_s` before the end of the frame.
  void Drive(const Eigen::Vector3d& gravity_m_s2, double left_s, double h_s);

  recon::BoneLengths lengths;
  CharacterOptions options;
  uint64_t made = 0;  // OdeWorld::made
  Character character;
  std::unique_ptr<JointLimits> limits;  // with CharacterOptions::joint_limits
  recon::Posture first;                 // posture when it was added
  std::array<FootPin, 2> foot_pin = {FootPin(15), FootPin(19)};
  std::map<size_t, Anchor> soft_constraint;
  std::map<size_t, std::unique_ptr<Pin>> hard_constraint;

 private:
  double SoleHeight() const;
  recon::JointOrientations OrientAim() const;
  recon::Posture Goal(recon::JointArray<double>& trust) const;
  void SetLean(const std::optional<Eigen::Vector4d>& floor, double dt_s);
  void SetLead(size_t joint, const std::optional<Eigen::Vector4d>& floor, double sole_m,
               double dt_s);
  Eigen::Vector3d Lead(size_t joint, const Eigen::Vector3d& velocity_m_s, double dt_s);
};

/// Height of a point above the plane a b c d.
inline double HeightAbove(const Eigen::Vector4d& floor, const Eigen::Vector3d& point) {
  return floor.head<3>().dot(point) + floor[3];
}

/// An object flying at a head: time and distance of its closest approach.
struct Threat {
  double time_s = 0;
  double distance_m = 0;
};
std::optional<Threat> ThreatTo(const Eigen::Vector3d& head_m, const Eigen::Vector3d& head_velocity,
                               const ObjectState& object);

/// The direction in which a flying object leaves most room beside `place_m`: a unit vector
/// perpendicular to `gravity_m_s2`; none if it passes at `near_m` or more. Assumes a ballistic
/// trajectory.
std::optional<Eigen::Vector3d> EscapeFrom(const ObjectState& thing, const Eigen::Vector3d& place_m,
                                          double near_m, const Eigen::Vector3d& gravity_m_s2);

/// Rotates head, trunk and arms about the hips.
void LeanBy(const Eigen::Vector3d& turn_rad, recon::Posture& target);

/// Sec. 8.2: moves the targets of elbows, wrists and hands so that the forearms cover the head.
void RaiseForearms(const recon::BoneLengths& lengths, recon::Posture& target);

}  // namespace ossa::physics
