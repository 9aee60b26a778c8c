#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/control.h"
#include "recon/posture.h"

namespace ossa::physics {

/// How a character follows its target.
enum class Control {
  kPaper,  // bounded PD forces on the joints and a bounded PD torque about each bone (the papers)
  kMotor,  // a servo motor in every ball joint and one that carries the trunk
};

/// Gravity, floor and step of a world.
struct WorldOptions {
  /// Simulation steps per 1/30 s; other time steps use as many as keep the step that short, so that
  /// stability does not depend on the frame rate. [5, 100]
  int substeps = 10;
  double gravity_m_s2 = 9.81;   // along the floor's normal; along -y without a floor
  double floor_friction = 0.9;  // Coulomb
  uint64_t seed = 1;            // of the constraint solver's row order
  void Check() const;           // throws std::invalid_argument
};

/// How a character is built and controlled.
struct CharacterOptions {
  Control control = Control::kPaper;
  ControlGains gains;
  /// Share of the target's velocity that the controller is told, [0, 1]. 0: a spring towards the
  /// newest posture as if that stood still, smoothest. 1: no lag behind steady motion, as with the
  /// target's derivative in eq. 1, but noise comes through.
  double lead = 0.0;
  bool pin_feet = true;
  /// Forearms, hands and legs go neither through each other nor through trunk and head. 3 cm of a
  /// limb are soft, as bodies are: a sensor's folded arms lie a little in the chest.
  bool self_collision = true;
  bool hinges = false;        // elbows and knees are hinges instead of ball joints (sec. 4)
  bool joint_limits = false;  // joints keep to the ranges that people's have
  bool dodge = false;  // raise the forearms around the head when something flies at it (sec. 8.2)
  double stature_m = 0.0;  // 0: from the bones
  double mass_kg = 0.0;    // 0: from the stature
  void Check(double step_s) const;
};

/// Where a character is and how it moves: joints in the world, metres.
struct CharacterState {
  recon::Posture posture;                // bone lengths exact
  recon::JointOrientations orientation;  // recon/orientation.h
  bool left_foot_pinned = false, right_foot_pinned = false;
  bool dodging = false;
  double max_anchor_gap_m = 0.0;  // between the two sides of a ball joint, now
  double max_solver_gap_m = 0.0;  // the same as the solver left it, largest of the last Step
  Eigen::Vector3d momentum_kg_m_s = Eigen::Vector3d::Zero();
  int rescued = 0;  // how often it was put back because its motion was not finite; 0 is wanted
};

enum class Shape { kBox, kBall, kCapsule };

/// A thing in the world: shape, mass, place.
struct ObjectOptions {
  Shape shape = Shape::kBox;
  Eigen::Vector3d size_m = {0.2, 0.2,
                            0.2};  // box: edges; ball: x = diameter; capsule: x = diameter,
                                   // y = length between the centres of its caps, along y
  double mass_kg = 1.0;            // by hand
  double friction = 0.8;           // Coulomb's coefficient, no unit; by hand: rubber on wood
  double bounce = 0.0;             // restitution, [0, 1)
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  void Check() const;
};

/// Where a thing is and how it moves, in the world.
struct ObjectState {
  Eigen::Vector3d position_m;
  Eigen::Quaterniond orientation;
  Eigen::Vector3d velocity_m_s;
};

/// A limb and an object that touched.
struct Strike {
  int character;
  size_t bone;  // the joint at its end
  int object;
};

/// What touched what in the last Step. Depths are the deepest overlap of any of its substeps.
struct ContactSummary {
  double character_object_depth_m = 0.0;
  double object_depth_m = 0.0;        // objects among themselves and with the floor
  double floor_depth_m = 0.0;         // characters in the floor
  double character_depth_m = 0.0;     // of two characters
  double self_depth_m = 0.0;          // a character's limbs in its trunk and each other
  int character_object_contacts = 0;  // summed over the substeps
  std::vector<Strike> struck;
};

/// A floor, characters and things that obey mechanics (Shum & Ho 2012, secs. 4 and 6). Metres,
/// seconds, any right-handed frame. Same calls, same seed: same bytes, in any thread.
class World {
 public:
  explicit World(const WorldOptions& options = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// a b c d of ax + by + cz + d = 0, unit normal up; none removes the floor. Sets gravity.
  void SetFloor(const std::optional<Eigen::Vector4d>& floor);

  /// Bone lengths in (0, 2] m; shorter than 1 cm is simulated as 1 cm. Throws InputError.
  int AddCharacter(const recon::BoneLengths& lengths, const recon::Posture& start,
                   const CharacterOptions& options = {});
  /// Where the character shall be at the end of the next Step. `weight` has one entry per joint in
  /// [0, 1] or is empty (all 1): small ones are followed more softly. Non-finite joints and joints
  /// of weight 0 keep their bone's present direction. `orientation`: how the bones shall be turned
  /// about themselves (recon/orientation.h), where that is known; else as the joints tell.
  void SetTarget(int character, const recon::Posture& target, std::span<const double> weight = {},
                 const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Lets the character fall: no control until the next SetTarget.
  void LetGo(int character);
  /// Stands the character still in the posture. What it holds goes along in its hand and stands
  /// still, too; constraints stay where they are and pull from there; impulses not yet spent are
  /// forgotten. `orientation` as in SetTarget.
  void Place(int character, const recon::Posture& posture,
             const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Of the whole character and of what it holds; nothing turns.
  void SetVelocity(int character, const Eigen::Vector3d& velocity_m_s);
  /// Sec. 6.1: this joint goes to this place, whatever the target says. `hard`: by a virtual joint
  /// (a stiff bounded spring: constraints that contradict each other are met half way).
  void Constrain(int character, recon::Joint joint, const Eigen::Vector3d& place_m, bool hard);
  void Unconstrain(int character, recon::Joint joint);
  /// An impulse at a joint, spent in the first substep of the next Step.
  void Push(int character, recon::Joint joint, const Eigen::Vector3d& impulse_ns);

  int AddObject(const ObjectOptions& options);
  /// A virtual joint between the end of a joint's bone and the object: `rigid` or free to turn
  /// about the joint. Neither that bone nor the one before it collides with the object meanwhile.
  void Hold(int character, recon::Joint joint, int object, bool rigid);
  void Release(int object);
  /// Hangs the object on a point of the world.
  void Hang(int object, const Eigen::Vector3d& point_m);

  /// dt in (0, 0.25] s.
  void Step(double dt_s);

  CharacterState StateOf(int character) const;
  ObjectState ObjectOf(int object) const;
  const ObjectOptions& ObjectInfo(int object) const;
  const ContactSummary& Contacts() const;
  bool IsFinite(int character) const;
  int CharacterCount() const;
  int ObjectCount() const;
  std::optional<Eigen::Vector4d> Floor() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::physics
