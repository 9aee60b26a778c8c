#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/world.h"
#include "recon/skeleton_sequence.h"
#include "tools/tracker/mechanics.h"

namespace ossa::tracker {

struct BodyFrame;

// Constants: chosen by hand, on tracked people in rendered scenes unless stated otherwise.

/// An object of a scene and its initial place.
struct SceneObject {
  /// The frame of its place; metres, y up along the floor's normal.
  enum class Origin {
    kFloor,   // the floor below the camera: x to the camera's left, z along its viewing direction
    kPerson,  // the floor below a person's hips: x to their left, z to their front
  };
  std::string name;
  physics::ObjectOptions body;  // position, orientation and velocities relative to `origin`
  Origin origin = Origin::kFloor;
  int person = 1;        // kPerson: the number of the person in order of appearance, from 1
  double after_s = 0.0;  // delay after the floor, or the person, was first seen
  double again_s =
      0.0;  // period after which it is placed there again while nobody holds it; 0: never
};

/// A hand at an object grabs it (Shum & Ho 2012, sec. 8.1; a virtual joint, 6.1).
struct GrabRule {
  std::vector<std::string> objects;  // names; empty: all dynamic objects
  std::vector<recon::Joint> joints = {recon::Joint::kHandLeft, recon::Joint::kHandRight};
  double near_m = 0.12;  // from the joint to the surface
  double slower_m_s =
      1.0;  // largest speed of the hand relative to the object; high, because catching is fast
  int hands = 1;               // number of hands required to hold it
  int people = 1;              // ... and of people, to lift it together
  double strength_n = 1000.0;  // force at which the hold breaks
  /// Torque beyond which an object turns in each of several hands that hold it: two palms carry a
  /// box without twisting it. A single hand holds it rigidly.
  double shared_torque_nm = 0.5;
};

/// A hand that moves away from the object it holds releases it.
struct ReleaseRule {
  std::vector<std::string> objects;
  double away_m =
      0.15;  // of the tracked joint from the surface, beyond the distance when it grabbed
  double for_s = 0.07;  // for this time
};

/// A swung object is released when the hand slows down, with the largest velocity of the swing
/// (sec. 8.3).
struct ThrowRule {
  std::vector<std::string> objects;
  double faster_m_s = 2.5;  // of the tracked joint; slower swings are no throws
};

/// People lean aside from objects flying at head or shoulders, and raise their arms (sec. 8.2).
struct DodgeRule {
  bool lean = true, cover = true;
};

/// Objects, and rules of interaction.
struct SceneOptions {
  std::vector<SceneObject> objects;
  std::vector<GrabRule> grabs;
  std::vector<ReleaseRule> releases;
  std::vector<ThrowRule> throws;
  std::optional<DodgeRule> dodge;
  /// a b c d in camera space, unit normal up. Without a value: the detected floor, and objects
  /// appear once it is detected.
  std::optional<Eigen::Vector4d> floor;
  physics::WorldOptions world;
  MechanicsBuild people;  // how the characters are built
  void Check() const;     // throws std::invalid_argument with name, value and range
};

/// Reads a scene file (docs/scene.md). Throws InputError with file, line, expectation.
SceneOptions LoadScene(const std::filesystem::path& file);

/// The state of an object at one time. Camera space, metres.
struct SceneObjectState {
  std::string name;
  physics::ObjectOptions body;  // its properties; the initial place in it is unused
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  std::vector<int> held_by;  // ids of bodies, ascending
};

/// As stored in skeleton files.
std::vector<recon::ObjectRecord> ToRecords(const std::vector<SceneObjectState>& objects);

/// An event of an object.
struct SceneEvent {
  enum class Kind { kAppeared, kGrabbed, kReleased, kThrown, kTorn } kind;
  std::string object;
  int body = 0;  // the person; 0: none
  recon::Joint joint = recon::Joint::kHipCenter;
};

/// All people of an image in one mechanical world with the objects of a scene, simulated frame by
/// frame. Any number and size of people; joints may be missing. A person out of view for half a
/// second is removed, and what they hold falls. When time runs backwards the world restarts.
class Scene {
 public:
  /// Throws std::invalid_argument for invalid options.
  explicit Scene(const SceneOptions& options);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Simulates up to the frame's time, with characters that follow its people; replaces their
  /// joints by those of the characters and sets its objects. Joints that were absent become
  /// inferred.
  void Play(BodyFrame& frame);
  void Play(recon::SkeletonFrame& frame);
  /// Removes all people and objects.
  void Reset();

  const std::vector<SceneObjectState>& objects() const;
  const std::vector<SceneEvent>& events() const;  // of the last frame
  bool has_floor() const;                         // without one no object has appeared
  /// The simulated world, for inspection and extension, in camera space.
  physics::World& world();
  /// The index of a person's character, and of an object, in the world; nothing if it does not
  /// exist.
  std::optional<int> CharacterOf(int body) const;
  std::optional<int> ObjectNamed(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::tracker
