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

// Constants: chosen by hand, on tracked people in rendered scenes, where nothing else is said.

/// A thing of a scene, and where it is put.
struct SceneObject {
  /// What its place is told from; metres, y up along the floor's normal.
  enum class Origin {
    kFloor,   // the floor under the camera: x to the camera's left, z the way it looks
    kPerson,  // the floor under somebody's hips: x to their left, z the way they face
  };
  std::string name;
  physics::ObjectOptions body;  // place, turn and velocities from `origin`
  Origin origin = Origin::kFloor;
  int person = 1;        // kPerson: the how-manieth that came into the picture
  double after_s = 0.0;  // it appears so long after the floor, or the person, was there
  double again_s =
      0.0;  // and is put there again each so many seconds while nobody holds it; 0: not
};

/// A hand that is at a thing takes hold of it (Shum & Ho 2012, sec. 8.1; a virtual joint, 6.1).
struct GrabRule {
  std::vector<std::string> objects;  // names; empty: all that move
  std::vector<recon::Joint> joints = {recon::Joint::kHandLeft, recon::Joint::kHandRight};
  double near_m = 0.12;        // from the joint to the surface
  double slower_m_s = 1.0;     // hand against thing; who catches is fast
  int hands = 1;               // so many must be at it to hold it, else nobody does
  int people = 1;              // ... of so many people: lifted together
  double strength_n = 1000.0;  // a hold breaks beyond
  /// Of several hands that hold a thing each lets it turn beyond this torque: two palms carry a box
  /// between them, they do not wring it. A hand that holds it alone holds it fast.
  // By hand: 2 kg, 2.5 cm off the line between the hands
  double shared_torque_nm = 0.5;
};

/// Who moves a hand away from what it holds lets go of it.
struct ReleaseRule {
  std::vector<std::string> objects;
  double away_m = 0.15;  // the tracked joint, further from the surface than where it took hold
  double for_s = 0.07;   // for so long
};

/// Who swings a thing lets go of it when the hand slows down again: it flies on as the hand went at
/// its fastest (sec. 8.3).
struct ThrowRule {
  std::vector<std::string> objects;
  double faster_m_s = 2.5;  // the tracked joint; slower swings are no throws
};

/// Before what flies at head or shoulders people lean aside, and raise their arms (sec. 8.2).
struct DodgeRule {
  bool lean = true, cover = true;
};

/// Things, and what people may do with them.
struct SceneOptions {
  std::vector<SceneObject> objects;
  std::vector<GrabRule> grabs;
  std::vector<ReleaseRule> releases;
  std::vector<ThrowRule> throws;
  std::optional<DodgeRule> dodge;
  /// a b c d in camera space, unit normal up. None: as it is seen; things wait for it.
  std::optional<Eigen::Vector4d> floor;
  physics::WorldOptions world;
  MechanicsBuild people;  // how their characters are built
  void Check() const;     // throws std::invalid_argument with name, value and range
};

/// Reads a scene file (docs/scene.md). Throws InputError: file, line, expectation.
SceneOptions LoadScene(const std::filesystem::path& file);

/// An object as it is at one moment. Camera space, metres.
struct SceneObjectState {
  std::string name;
  physics::ObjectOptions body;  // what it is made of; its place is not read
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  std::vector<int> held_by;  // ids of bodies, ascending
};

/// As skeleton files hold them.
std::vector<recon::ObjectRecord> ToRecords(const std::vector<SceneObjectState>& objects);

/// What happened to an object.
struct SceneEvent {
  enum class Kind { kAppeared, kGrabbed, kReleased, kThrown, kTorn } kind;
  std::string object;
  int body = 0;  // who did it; 0: nobody
  recon::Joint joint = recon::Joint::kHipCenter;
};

/// All people of a picture in one mechanical world with the things of a scene, moment by moment.
/// People come and go; any size; joints may be missing. Who is out of the picture for half a second
/// is out of the world, and what they hold falls. A world that time runs back in begins anew.
class Scene {
 public:
  /// Throws std::invalid_argument for options that cannot be.
  explicit Scene(const SceneOptions& options);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Moves the world on to the frame's time, people as they are seen; puts their joints where the
  /// world lets them be, and tells its things. Joints that were absent come out inferred.
  void Play(BodyFrame& frame);
  void Play(recon::SkeletonFrame& frame);
  /// Everybody leaves, nothing is there.
  void Reset();

  const std::vector<SceneObjectState>& objects() const;
  const std::vector<SceneEvent>& events() const;  // of the last moment
  bool has_floor() const;                         // without one no thing has appeared
  /// The world, to look into or to do more with: its frame is camera space.
  physics::World& world();
  /// The number of a person's character, of a thing's object; none where it is not there.
  std::optional<int> CharacterOf(int body) const;
  std::optional<int> ObjectNamed(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::tracker
