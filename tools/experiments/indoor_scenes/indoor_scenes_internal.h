#pragma once
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "recon/body/rig.h"
#include "tools/experiments/compare/joint_track.h"
#include "tools/experiments/experiment.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/view_sampler.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {

// People in rendered indoor scenes, and the evaluation of detection and identities.

enum class Furnishing {
  kEmpty,       // floor, walls, ceiling
  kFurnished,   // things along the walls and between the people
  kSofa,        // a sofa at everybody's calves
  kTable,       // a table that touches everybody from the sensor's side
  kWall,        // a wall at everybody's back
  kSofaBefore,  // a sofa or an armchair between everybody and the sensor, from either side of it
};

struct IndoorScenario {
  std::string name;
  int people = 1;
  Furnishing furnishing = Furnishing::kFurnished;
  bool crossing = false;  // all people walk past each other, each on their own lane
  bool close = false;     // a sensor at head's height near the people, that sees no floor
  bool still = false;     // 3 m away without moving
};

std::vector<IndoorScenario> IndoorScenarios();

/// Between the lanes of people who cross; by hand: at arm's length.
inline constexpr double kUsualLane_m = 0.85;

/// Body model, clothes and motions that all scenarios share, and the size of their sequences.
struct IndoorSceneInputs {
  const recon::BodyModel& model;
  const recon::Wardrobe& wardrobe;
  const std::vector<recon::MotionClip>& clips;
  Split split = Split::kTest;  // of bodies
  int width = 640, height = 480;
  int64_t frames = 90;     // at 30 Hz,
  int64_t frame_step = 1;  // ... of which each of this many reaches the tracker: a slower camera
  bool carried = false;    // whether the sensor is carried around instead of standing still
  double lane_m = kUsualLane_m;  // between the lanes of people who cross
};

/// One performance of a scenario: same scenario, inputs and seed, same frames.
class IndoorSceneRenderer {
 public:
  IndoorSceneRenderer(const IndoorScenario& scenario, const IndoorSceneInputs& inputs,
                      uint64_t seed);
  LabelledFrame RenderFrame(int64_t index);
  int64_t size() const { return inputs_.frames; }

 private:
  struct Way {  // of one person
    std::vector<recon::RigPose> poses;
    // Of the hips on the floor, at the first and last frame.
    Eigen::Vector3d from_m = Eigen::Vector3d::Zero(), to_m = Eigen::Vector3d::Zero();
    double heading_rad = 0;
  };
  struct Thing {
    int mesh = 0;                // id in the renderer
    depth::TriangleMesh mesh_m;  // in the world
  };

  void PlaceSensor(Random& random);
  void PlacePeople(Random& random);
  void Furnish(Random& random);
  void StandSofaBefore(const Eigen::Vector3d& person_m, Random& random);
  Way Staying(int person, Random& random) const;
  Way Crossing(int person, Random& random) const;
  recon::RigPose PoseAt(const Way& way, double root_scale, int64_t index) const;
  void Stand(const depth::TriangleMesh& mesh, const Eigen::Vector3d& place_m, double turn_rad);
  void MoveSensor(int64_t index);

  IndoorScenario scenario_;
  IndoorSceneInputs inputs_;
  uint64_t seed_;
  depth::Camera camera_;
  Eigen::Isometry3d camera_from_world_;
  Eigen::Vector3d sensor_m_, aim_m_;  // in the world, at first; what it is aimed at
  double distance_m_ = 3;             // of the people's middle, which is the world's origin
  std::vector<Thing> things_;         // if the sensor is carried
  std::vector<Way> ways_;
  std::vector<ClothedBody> bodies_;
  depth::Renderer renderer_;
};

/// Counts and errors over the frames of one scenario.
struct IndoorScore {
  int64_t frames = 0, in_view = 0, found = 0;  // people, frame by frame
  int64_t cut = 0;                             // extra bodies on people who already have a body
  int64_t invented = 0;                        // bodies that are not people
  int64_t switches = 0;                        // a person's id differs from when last found
  double iou = 0;                              // summed over found
  PairedTracks raw, final;
  PairedTracks raw_seen;  // raw, without joints that others, the person or the image's edge hide

  void Add(const IndoorScore& other);
};

/// Evaluates the results of a tracker, frame by frame.
class IndoorEvaluator {
 public:
  void AddFrame(const LabelledFrame& truth, const tracker::BodyFrame& answer);
  IndoorScore score;

 private:
  void AddPerson(const TruthBody& truth, const tracker::BodyFrame& answer, int body, double time_s);
  std::map<int, int> id_of_person_;  // when last found
};

}  // namespace ossa::tools
