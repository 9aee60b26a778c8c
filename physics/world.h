#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/character.h"
#include "recon/posture.h"

namespace ossa::physics {

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

enum class Shape { kBox, kBall, kCapsule };

/// What moves an object.
enum class BodyKind {
  kDynamic,    // forces, gravity and contacts
  kKinematic,  // the application, by SetObjectVelocity and MoveTo; it pushes and is not pushed
  kStatic,     // nothing
};

/// A further part of an object of several, fixed to the first; place and turn in the object's
/// frame.
struct ObjectPart {
  Shape shape = Shape::kBox;
  Eigen::Vector3d size_m = {0.2, 0.2, 0.2};  // as ObjectOptions::size_m
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// A thing in the world: shape, mass, place. Air takes 14 % of its speed a second.
struct ObjectOptions {
  Shape shape = Shape::kBox;
  Eigen::Vector3d size_m = {0.2, 0.2,
                            0.2};  // box: edges; ball: x = diameter; capsule: x = diameter,
                                   // y = length between the centres of its caps, along y
  double mass_kg = 1.0;            // by hand; of all parts, which are of one density
  double friction = 0.8;           // Coulomb's coefficient, no unit; by hand: rubber on wood
  double bounce = 0.0;             // restitution, [0, 1)
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the object's frame: shape's middle
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  // of the centre of mass
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  BodyKind kind = BodyKind::kDynamic;
  std::vector<ObjectPart> parts;
  /// Bit masks, by convention: two meet if each is in a group the other collides with.
  uint32_t groups = 1, collides_with = ~0U;
  void Check() const;
};

/// Where a thing is and how it moves, in the world.
struct ObjectState {
  Eigen::Vector3d position_m;
  Eigen::Quaterniond orientation;
  Eigen::Vector3d velocity_m_s;  // of the centre of mass
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
};

/// A limb and an object that touched.
struct Strike {
  int character;
  size_t bone;  // the joint at its end
  int object;
};

/// A joint whose bone holds an object.
struct Holder {
  int character;
  recon::Joint joint;
  bool operator==(const Holder&) const = default;
};

/// One side of a contact.
struct Party {
  enum class Kind { kFloor, kCharacter, kObject } kind = Kind::kFloor;
  int id = 0;       // of the character or object
  size_t bone = 0;  // of a character: the joint at its end
  bool operator==(const Party&) const = default;
};

/// Where two parties press on each other.
struct ContactPoint {
  Eigen::Vector3d position_m;  // world
  Eigen::Vector3d normal;      // unit, from b into a
  double depth_m = 0.0;        // overlap; below 0: not quite there yet
  Eigen::Vector3d impulse_ns;  // on a, in one substep
};

/// Two parties that pressed on each other in the last Step.
struct Contact {
  Party a, b;
  std::vector<ContactPoint> points;                      // of the last substep in which they did
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();  // on a, of the whole Step
  bool began = false;                                    // they had not in the Step before
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
  std::vector<Contact> contacts;  // in a fixed order; a character's own limbs among them
  std::vector<int> broken;        // objects of which a hold broke
};

/// What a world asks and tells while it steps. Any may be empty; none may call the world's Step,
/// Restore or what removes something. An exception leaves Step in between two substeps.
struct WorldCallbacks {
  /// Whether two that are near may meet; asked of all but the floor and a character's own limbs.
  std::function<bool(const Party&, const Party&)> may_meet;
  std::function<void(double h_s)> before_substep;        // h_s: how long it is
  std::function<void(const Contact&)> on_first_contact;  // at the end of the Step
  std::function<void(int object)> on_broken_hold;        // at the end of the Step
};

/// All of a world at one moment, see World::Save. A value: copies are cheap and last.
class WorldSnapshot {
 public:
  struct Data;

 private:
  friend class World;
  std::shared_ptr<const Data> data_;
};

/// A floor, characters and things that obey mechanics (Shum & Ho 2012, secs. 4 and 6). Metres,
/// seconds, any right-handed frame. Same calls, same seed: same bytes, in any thread. Worlds share
/// nothing: each may be used in a thread of its own, one world in one thread at a time. Numbers of
/// characters and objects count up from 0 and are never given again; std::out_of_range is thrown
/// for those that are not (or no longer) there.
class World {
 public:
  explicit World(const WorldOptions& options = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// a b c d of ax + by + cz + d = 0, unit normal up; none removes the floor. Sets gravity.
  void SetFloor(const std::optional<Eigen::Vector4d>& floor);
  void SetCallbacks(WorldCallbacks callbacks);

  /// Bone lengths in (0, 2] m; shorter than 1 cm is simulated as 1 cm. Throws InputError.
  int AddCharacter(const recon::BoneLengths& lengths, const recon::Posture& start,
                   const CharacterOptions& options = {});
  /// What it holds falls.
  void RemoveCharacter(int character);
  /// Back to its first posture, at rest, without constraints; what it holds falls.
  void ResetCharacter(int character);
  /// Where the character shall be at the end of the next Step. `weight` has one entry per joint in
  /// [0, 1] or is empty (all 1): small ones are followed more softly. Non-finite joints and joints
  /// of weight 0 keep their bone's present direction. `orientation`: how the bones shall be turned
  /// about themselves (recon/orientation.h), where that is known; else as the joints tell.
  void SetTarget(int character, const recon::Posture& target, std::span<const double> weight = {},
                 const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Lets the character fall: no control until the next SetTarget.
  void StopControl(int character);
  /// Stands the character still in the posture. What it holds goes along in its hand (the first, of
  /// several that hold it, and the others let go) and stands still, too; constraints stay where
  /// they are and pull from there; impulses not yet spent are forgotten. `orientation` as in
  /// SetTarget.
  void Place(int character, const recon::Posture& posture,
             const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Of the whole character and of what it holds; nothing turns.
  void SetVelocity(int character, const Eigen::Vector3d& velocity_m_s);
  /// Sec. 6.1: this joint goes to this place, whatever the target says. `hard`: by a virtual joint
  /// (a stiff bounded spring: constraints that contradict each other are met half way).
  void Constrain(int character, recon::Joint joint, const Eigen::Vector3d& place_m, bool hard);
  /// The same with a point of an object's frame, which may move; hard ones pull the object, too.
  void ConstrainTo(int character, recon::Joint joint, int object, const Eigen::Vector3d& point_m,
                   bool hard);
  void Unconstrain(int character, recon::Joint joint);
  /// An impulse at a joint, spent in the first substep of the next Step.
  void ApplyImpulse(int character, recon::Joint joint, const Eigen::Vector3d& impulse_ns);
  /// A force at a joint for the whole of the next Step.
  void ApplyForce(int character, recon::Joint joint, const Eigen::Vector3d& force_n);

  int AddObject(const ObjectOptions& options);
  void RemoveObject(int object);
  /// Back to where and how it was added; nobody holds it.
  void ResetObject(int object);
  /// Puts the object there; nobody holds it any more. Velocities stay.
  void SetPose(int object, const Eigen::Vector3d& position_m,
               const Eigen::Quaterniond& orientation);
  void SetObjectVelocity(int object, const Eigen::Vector3d& velocity_m_s,
                         const Eigen::Vector3d& angular_velocity_rad_s = Eigen::Vector3d::Zero());
  /// A kinematic object arrives there at the end of the next Step, and stays.
  void MoveTo(int object, const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);
  /// A force at a point of the world, a torque, for the whole of the next Step.
  void ApplyForceToObject(int object, const Eigen::Vector3d& force_n, const Eigen::Vector3d& at_m,
                          const Eigen::Vector3d& torque_nm = Eigen::Vector3d::Zero());
  /// An impulse at a point of the world, at once.
  void ApplyImpulseToObject(int object, const Eigen::Vector3d& impulse_ns,
                            const Eigen::Vector3d& at_m);

  /// A virtual joint between the end of a joint's bone and the object: `rigid` or free to turn
  /// about the joint. Neither that bone nor the one before it collides with the object meanwhile.
  /// Breaks where it would have to pull harder than `strength_n`; turns in the hand, as by
  /// friction, where a rigid one would have to turn harder than `torque_nm` about an axis of the
  /// bone. Several joints, of several characters, may hold one object: they carry it together.
  /// Those of a finite torque share its weight, and slip along the line between them, no further
  /// than to the surface, until they no longer press on each other through it. Who hung it up lets
  /// go of it.
  void Hold(int character, recon::Joint joint, int object, bool rigid,
            double strength_n = std::numeric_limits<double>::infinity(),
            double torque_nm = std::numeric_limits<double>::infinity());
  /// All that hold it, or that hangs it, let go; or that joint does, if it holds it.
  void Release(int object);
  void Release(int object, int character, recon::Joint joint);
  std::vector<Holder> HoldersOf(int object) const;  // in the order in which they took it
  /// Hangs the object on a point of the world.
  void Hang(int object, const Eigen::Vector3d& point_m);

  /// dt in (0, 0.25] s.
  void Step(double dt_s);

  /// Everything but the callbacks. Restored, in this or another world, the same calls give the same
  /// bytes.
  WorldSnapshot Save() const;
  void Restore(const WorldSnapshot& snapshot);

  CharacterState StateOf(int character) const;
  ObjectState ObjectOf(int object) const;
  /// From a point of the world to the object's surface, metres; below 0 inside.
  double DistanceTo(int object, const Eigen::Vector3d& point_m) const;
  const ObjectOptions& ObjectInfo(int object) const;
  const ContactSummary& Contacts() const;
  bool IsFinite(int character) const;
  int CharacterCount() const;
  int ObjectCount() const;
  std::vector<int> Characters() const;  // numbers of those that are there, ascending
  std::vector<int> Objects() const;
  std::optional<Eigen::Vector4d> Floor() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::physics
