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
  uint64_t seed = 1;            // for the constraint solver's row order
  void Check() const;           // throws std::invalid_argument
};

enum class Shape { kBox, kBall, kCapsule };

/// What moves an object.
enum class BodyKind {
  kDynamic,    // forces, gravity and contacts
  kKinematic,  // the application, by SetObjectVelocity and MoveTo; contacts do not move it
  kStatic,     // nothing
};

/// A further shape of a compound object, fixed to the first one; position and orientation in the
/// object's frame.
struct ObjectPart {
  Shape shape = Shape::kBox;
  Eigen::Vector3d size_m = {0.2, 0.2, 0.2};  // as ObjectOptions::size_m
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Shape, mass and initial state of an object. Air drag takes 14 % of its speed a second.
struct ObjectOptions {
  Shape shape = Shape::kBox;
  Eigen::Vector3d size_m = {0.2, 0.2,
                            0.2};  // box: edges; ball: x = diameter; capsule: x = diameter,
                                   // y = length between the centres of its caps, along y
  double mass_kg = 1.0;            // by hand; of all parts, which have the same density
  double friction = 0.8;           // Coulomb's coefficient, no unit; by hand: rubber on wood
  double bounce = 0.0;             // restitution, [0, 1)
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of the object's frame: shape's centre
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  // of the centre of mass
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  BodyKind kind = BodyKind::kDynamic;
  std::vector<ObjectPart> parts;
  /// Bit masks: two collide if each is in a group that the other collides with. By convention.
  uint32_t groups = 1, collides_with = ~0U;
  void Check() const;
};

/// Pose and velocity of an object, in the world.
struct ObjectState {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  // of the centre of mass
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
};

/// A contact between a limb and an object.
struct Strike {
  int character = 0;
  size_t bone = 0;  // the joint at its end
  int object = 0;
};

/// A joint that holds an object.
struct Holder {
  int character = 0;
  recon::Joint joint{};
  bool operator==(const Holder&) const = default;
};

/// One of the two participants in a contact.
struct Party {
  enum class Kind { kFloor, kCharacter, kObject } kind = Kind::kFloor;
  int id = 0;       // of the character or object
  size_t bone = 0;  // of a character: the joint at its end
  bool operator==(const Party&) const = default;
};

/// A point at which two parties press on each other.
struct ContactPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // world
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();      // unit, from b into a
  double depth_m = 0.0;                                  // overlap; below 0: a gap
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();  // on a, in one substep
};

/// Two parties that pressed on each other in the last Step.
struct Contact {
  Party a, b;
  std::vector<ContactPoint> points;                      // of the last substep with contact
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();  // on a, of the whole Step
  bool began = false;                                    // there was none in the Step before
};

/// All contacts of the last Step. Depths are the deepest overlap of any of its substeps.
struct ContactSummary {
  double character_object_depth_m = 0.0;
  double object_depth_m = 0.0;        // between objects, and of objects in the floor
  double floor_depth_m = 0.0;         // characters in the floor
  double character_depth_m = 0.0;     // of two characters
  double self_depth_m = 0.0;          // of a character's limbs in its trunk and each other
  int character_object_contacts = 0;  // summed over the substeps
  std::vector<Strike> struck;
  std::vector<Contact> contacts;  // in a fixed order; includes a character's own limbs
  std::vector<int> broken;        // objects with a hold that broke
};

/// Callbacks of a world while it steps. Any may be empty; none may call the world's Step, Restore
/// or a function that removes something. An exception leaves Step between two substeps.
struct WorldCallbacks {
  /// Whether two parties may collide; called for all but the floor and a character's own limbs.
  std::function<bool(const Party&, const Party&)> may_meet;
  std::function<void(double h_s)> before_substep;        // h_s: its duration, seconds
  std::function<void(const Contact&)> on_first_contact;  // at the end of the Step
  std::function<void(int object)> on_broken_hold;        // at the end of the Step
};

/// The state of a world at one time, see World::Save. A value: copies are cheap and independent.
class WorldSnapshot {
 public:
  struct Data;

 private:
  friend class World;
  std::shared_ptr<const Data> data_;
};

/// A physics simulation of a floor, characters and objects (Shum & Ho 2012, secs. 4 and 6). Metres,
/// seconds, any right-handed frame. The same calls and seed give the same bytes, in any thread.
/// Worlds share nothing and may run in different threads; one world must not be used by two threads
/// at once. Ids of characters and of objects count up from 0 and are never reused; an id that does
/// not (or no longer) exist throws std::out_of_range.
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
  /// Objects that it holds fall.
  void RemoveCharacter(int character);
  /// Back to its first posture, at rest, without constraints; objects that it holds fall.
  void ResetCharacter(int character);
  /// Target posture at the end of the next Step. `weight` has one entry per joint in [0, 1] or is
  /// empty (all 1): joints of small weight are followed more softly. Non-finite joints and joints
  /// of weight 0 keep their bone's present direction. `orientation`: rotations of the bones, also
  /// about their own axes (recon/orientation.h), if known; else they follow from the joints.
  void SetTarget(int character, const recon::Posture& target, std::span<const double> weight = {},
                 const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Lets the character fall: no control until the next SetTarget.
  void StopControl(int character);
  /// Puts the character into the posture, at rest. An object that it holds moves along, at rest,
  /// too (if several characters hold it, with the first; the others release it). Constraints stay
  /// at their positions and pull from there; pending impulses are discarded. `orientation` as in
  /// SetTarget.
  void Place(int character, const recon::Posture& posture,
             const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Velocity of the whole character and of what it holds, without rotation.
  void SetVelocity(int character, const Eigen::Vector3d& velocity_m_s);
  /// Sec. 6.1: pulls the joint to this position, whatever its target. `hard`: by a virtual joint (a
  /// stiff bounded spring, so that contradicting constraints are met half way).
  void Constrain(int character, recon::Joint joint, const Eigen::Vector3d& place_m, bool hard);
  /// The same with a point in an object's frame, which may move; hard ones also pull the object.
  void ConstrainTo(int character, recon::Joint joint, int object, const Eigen::Vector3d& point_m,
                   bool hard);
  void Unconstrain(int character, recon::Joint joint);
  /// An impulse at a joint, applied in the first substep of the next Step.
  void ApplyImpulse(int character, recon::Joint joint, const Eigen::Vector3d& impulse_ns);
  /// A force at a joint for the whole of the next Step.
  void ApplyForce(int character, recon::Joint joint, const Eigen::Vector3d& force_n);

  int AddObject(const ObjectOptions& options);
  void RemoveObject(int object);
  /// Back to its initial state; all holds are released.
  void ResetObject(int object);
  /// Moves the object at once; all holds are released. Velocities stay.
  void SetPose(int object, const Eigen::Vector3d& position_m,
               const Eigen::Quaterniond& orientation);
  void SetObjectVelocity(int object, const Eigen::Vector3d& velocity_m_s,
                         const Eigen::Vector3d& angular_velocity_rad_s = Eigen::Vector3d::Zero());
  /// A kinematic object arrives there at the end of the next Step, and stays.
  void MoveTo(int object, const Eigen::Vector3d& position_m, const Eigen::Quaterniond& orientation);
  /// A force at a point of the world and a torque, for the whole of the next Step.
  void ApplyForceToObject(int object, const Eigen::Vector3d& force_n, const Eigen::Vector3d& at_m,
                          const Eigen::Vector3d& torque_nm = Eigen::Vector3d::Zero());
  /// An impulse at a point of the world, at once.
  void ApplyImpulseToObject(int object, const Eigen::Vector3d& impulse_ns,
                            const Eigen::Vector3d& at_m);

  /// A virtual joint between the end of a joint's bone and the object: `rigid`, or free to rotate
  /// about the joint. Neither that bone nor its parent collides with the object while it is held.
  /// The hold breaks above the force `strength_n`; a rigid one slips, as by friction, above the
  /// torque `torque_nm` about an axis of the bone. Several joints of several characters may hold
  /// one object and carry it together. Those of finite torque share its weight, and slide along the
  /// line between them, at most to the surface, until they no longer press on each other through
  /// it.
  /// An object that hangs on a point (Hang) is taken off it.
  void Hold(int character, recon::Joint joint, int object, bool rigid,
            double strength_n = std::numeric_limits<double>::infinity(),
            double torque_nm = std::numeric_limits<double>::infinity());
  /// Releases all holds and the point on which it hangs, or the hold of one joint, if any.
  void Release(int object);
  void Release(int object, int character, recon::Joint joint);
  std::vector<Holder> HoldersOf(int object) const;  // in the order in which they took hold
  /// Hangs the object on a point of the world.
  void Hang(int object, const Eigen::Vector3d& point_m);

  /// dt in (0, 0.25] s.
  void Step(double dt_s);

  /// The whole state but the callbacks. After Restore, in this or another world, the same calls
  /// give the same bytes.
  WorldSnapshot Save() const;
  void Restore(const WorldSnapshot& snapshot);

  CharacterState StateOf(int character) const;
  ObjectState ObjectOf(int object) const;
  /// Distance of a point of the world from the object's surface, metres; negative inside.
  double DistanceTo(int object, const Eigen::Vector3d& point_m) const;
  const ObjectOptions& ObjectInfo(int object) const;
  const ContactSummary& Contacts() const;
  bool IsFinite(int character) const;
  int CharacterCount() const;
  int ObjectCount() const;
  std::vector<int> Characters() const;  // ids of those that exist, ascending
  std::vector<int> Objects() const;
  std::optional<Eigen::Vector4d> Floor() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::physics
