// People and furniture in front of a virtual sensor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depth/render/shapes.h"
#include "tools/experiments/indoor_scenes/indoor_scenes_internal.h"
#include "tools/synth/pose_bank.h"
#include "tools/synth/props.h"
#include "tools/synth/sample_person.h"
#include "tools/synth/sequence_poses.h"
#include "tools/synth/visibility_internal.h"

namespace ossa::tools {
namespace {

// Constants: of the scenes that are played, by hand.

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kHalfView = 0.45;  // x / z up to which people stay wholly in view; ratio of a
                                    // Kinect v1's half width to its distance (0.55), less a margin

// The part of a clip with the longest path within `frames` frames, heading removed, for people who
// cross a room.
std::vector<recon::RigPose> WalkPoses(const std::vector<recon::MotionClip>& clips, int64_t frames,
                                      Random& random) {
  constexpr double kFarEnough_m = 1.8;
  const auto way = [&](const recon::MotionClip& clip) {
    const size_t last = std::min(clip.frames.size(), static_cast<size_t>(frames)) - 1;
    Vector3d step = clip.frames[last].root_m - clip.frames[0].root_m;
    step.y() = 0;
    return step;
  };
  std::vector<const recon::MotionClip*> walks;
  const recon::MotionClip* farthest = nullptr;
  for (const auto& clip : clips) {
    if (clip.frames.empty()) continue;
    const double far_m = way(clip).norm();
    if (farthest == nullptr || far_m > way(*farthest).norm()) farthest = &clip;
    if (far_m > kFarEnough_m) walks.push_back(&clip);
  }
  if (farthest == nullptr) return {};
  const auto& clip = walks.empty() ? *farthest : *walks[random.Index(walks.size())];
  const Vector3d step = way(clip);
  // The walking direction becomes +z, the direction that a person at rest faces.
  const double turn_rad = step.norm() > 0.3 ? -std::atan2(step.x(), step.z()) : 0.0;
  std::vector<recon::RigPose> poses(
      clip.frames.begin(),
      clip.frames.begin() + std::min(std::ssize(clip.frames), static_cast<std::ptrdiff_t>(frames)));
  const Vector3d origin(poses[0].root_m.x(), 0, poses[0].root_m.z());
  for (auto& pose : poses) {
    pose.root_m -= origin;
    pose = Turned(pose, turn_rad);
  }
  return poses;
}

}  // namespace

std::vector<IndoorScenario> IndoorScenarios() {
  std::vector<IndoorScenario> all = {
      {"nobody, furnished", 0, Furnishing::kFurnished, false, false},
      {"one, empty room", 1, Furnishing::kEmpty, false, false},
      {"one, furnished", 1, Furnishing::kFurnished, false, false},
      {"one, sofa behind", 1, Furnishing::kSofa, false, false},
      {"one, table before", 1, Furnishing::kTable, false, false},
      {"one, wall behind", 1, Furnishing::kWall, false, false},
      {"one, no floor in view", 1, Furnishing::kFurnished, false, true},
  };
  for (int people = 2; people <= 6; ++people) {
    all.push_back({fmt::format("{} standing", people), people, Furnishing::kFurnished});
  }
  all.push_back({"2 crossing, empty room", 2, Furnishing::kEmpty, true, false});
  for (int people = 2; people <= 4; ++people) {
    all.push_back({fmt::format("{} crossing", people), people, Furnishing::kFurnished, true});
  }
  all.push_back({.name = "one, still at 3 m", .still = true});
  all.push_back({"one, sofa before", 1,
                 Furnishing::kSofaBefore});  // last, so that the others keep their seeds
  return all;
}

IndoorSceneRenderer::IndoorSceneRenderer(const IndoorScenario& scenario,
                                         const IndoorSceneInputs& inputs, uint64_t seed)
    : scenario_(scenario),
      inputs_(inputs),
      seed_(seed),
      camera_(depth::KinectV1Camera(inputs.width, inputs.height)) {
  Random random(seed, 5);
  PlaceSensor(random);
  PlacePeople(random);
  Furnish(random);
}

void IndoorSceneRenderer::PlaceSensor(Random& random) {
  // Lanes and rows of many people need more room than one.
  distance_m_ = scenario_.close ? random.Uniform(1.4, 1.8)
                                : random.Uniform(2.2, 2.9) + 0.22 * (scenario_.people - 1);
  const double height_m = scenario_.close ? 1.45 : random.Uniform(0.7, 1.9);
  if (scenario_.still) distance_m_ = 3.0;
  const double aim_m = scenario_.close ? 1.4 : random.Uniform(0.8, 1.0);
  sensor_m_ = {0, height_m, distance_m_};
  aim_m_ = {0, aim_m, 0};
  camera_from_world_ = LookAt(sensor_m_, aim_m_);
}

// Like a sensor in somebody's hand: within three seconds it is carried to the left, to the right
// and back, nearer and farther, and aimed beside the people.
void IndoorSceneRenderer::MoveSensor(int64_t index) {
  constexpr double kPeriod = 90;  // frames
  const double phase_rad = 2 * std::numbers::pi * static_cast<double>(index) / kPeriod;
  const double aside = std::sin(phase_rad), along = std::sin(0.7 * phase_rad);
  camera_from_world_ =
      LookAt(sensor_m_ + Vector3d(0.3 * aside, 0.05 * along, 0.25 * along),  // metres
             aim_m_ + Vector3d(-0.4 * aside, 0.1 * along, 0));
  for (const Thing& thing : things_)
    renderer_.UpdateVertices(
        thing.mesh,
        depth::Moved(thing.mesh_m, Eigen::Affine3f(camera_from_world_.matrix().cast<float>()))
            .vertices_m);
}

void IndoorSceneRenderer::PlacePeople(Random& random) {
  for (int person = 0; person < scenario_.people; ++person) {
    const recon::BodyShape shape = SampleShape(inputs_.split, random);
    bodies_.emplace_back(inputs_.model, inputs_.wardrobe, shape, SampleClothing(random));
    bodies_.back().AddTo(renderer_);
    ways_.push_back(scenario_.crossing ? Crossing(person, random) : Staying(person, random));
  }
}

// People side by side, every other one nearer.
IndoorSceneRenderer::Way IndoorSceneRenderer::Staying(int person, Random& random) const {
  Way way;
  way.poses = SequencePoses(inputs_.clips, inputs_.frames, random.Bits());
  const double column =
      scenario_.people == 1 ? random.Uniform(-0.3, 0.3) : 2 * (person + 0.5) / scenario_.people - 1;
  const double row_m = scenario_.people == 1 ? 0.0 : person % 2 ? 0.45 : -0.35;
  const double z_m = row_m + random.Uniform(-0.15, 0.15);
  way.from_m = {column * kHalfView * (distance_m_ - z_m), 0, z_m};
  way.to_m = way.from_m;
  way.heading_rad = random.Uniform(-0.9, 0.9);
  return way;
}

// People on lanes at different depths, walking left and right alternately.
IndoorSceneRenderer::Way IndoorSceneRenderer::Crossing(int person, Random& random) const {
  Way way;
  way.poses = WalkPoses(inputs_.clips, inputs_.frames, random);
  const double side = person % 2 ? 1 : -1;
  const double z_m = inputs_.lane_m * (person - 0.5 * (scenario_.people - 1));
  const double half_m = kHalfView * std::max(1.2, distance_m_ - z_m) * random.Uniform(0.7, 0.95);
  way.from_m = {-side * half_m, 0, z_m};
  way.to_m = {side * half_m, 0, z_m};
  way.heading_rad = side * std::numbers::pi / 2;
  return way;
}

// A clip shorter than the sequence is played forwards and backwards, a walk more slowly. If the
// walk is shorter or longer than its lane, the feet slide a little.
recon::RigPose IndoorSceneRenderer::PoseAt(const Way& way, double root_scale, int64_t index) const {
  const auto count = std::ssize(way.poses);
  const double share =
      static_cast<double>(index) / static_cast<double>(std::max<int64_t>(1, size() - 1));
  int64_t at = std::lround(share * static_cast<double>(count - 1));
  if (scenario_.still) {
    at = 0;
  } else if (!scenario_.crossing) {
    const int64_t period = std::max<int64_t>(1, 2 * count - 2);
    at = std::min(index % period, period - index % period);
  }
  recon::RigPose pose = Turned(way.poses[static_cast<size_t>(at)], way.heading_rad);
  if (scenario_.crossing) {
    const Vector3d walked = Turned(way.poses.back(), way.heading_rad).root_m * root_scale;
    const Vector3d missing = way.to_m - way.from_m - Vector3d(walked.x(), 0, walked.z());
    pose.root_m += share * missing / root_scale;
  }
  pose.root_m += way.from_m / root_scale;
  return pose;
}

void IndoorSceneRenderer::Stand(const depth::TriangleMesh& mesh, const Vector3d& place_m,
                                double turn_rad) {
  Eigen::Affine3f place(camera_from_world_.matrix().cast<float>());
  place.translate(place_m.cast<float>());
  place.rotate(Eigen::AngleAxisf(static_cast<float>(turn_rad), Vector3f::UnitY()));
  const int id = renderer_.AddMesh(depth::Moved(mesh, place), inputs_.carried);
  if (!inputs_.carried) return;
  const Eigen::Affine3f world_from_camera(camera_from_world_.inverse().matrix().cast<float>());
  things_.push_back({id, depth::Moved(mesh, world_from_camera * place)});
}

// A sofa or an armchair between person and sensor that hides at least the legs.
void IndoorSceneRenderer::StandSofaBefore(const Vector3d& person_m, Random& random) {
  constexpr double kDepth_m = 0.6, kBack_m = 0.2;
  const auto width_m = static_cast<float>(random.Uniform(0.5, 1.6));
  const auto seat_m = static_cast<float>(random.Uniform(0.5, 0.85));
  const bool back_to_sensor = random.Chance(0.5);
  const double gap_m = random.Uniform(0.2, 0.4);
  const double z_m = gap_m + kDepth_m / 2 + (back_to_sensor ? 0 : kBack_m);
  Stand(depth::MakeSofa(width_m, static_cast<float>(kDepth_m), seat_m),
        person_m + Vector3d(random.Uniform(-0.15, 0.15), 0, z_m),
        back_to_sensor ? std::numbers::pi : 0.0);
}

void IndoorSceneRenderer::Furnish(Random& random) {
  const double rear_m = 0.45 + 0.45 * (scenario_.people - 1);  // behind the last lane or row
  const bool tight = scenario_.furnishing == Furnishing::kWall;
  const double behind_m = tight && scenario_.people == 1 ? 0.45 : rear_m + random.Uniform(0.3, 1.5);
  const double before_m = distance_m_ + 0.8;
  const double width_m = random.Uniform(4.0, 6.0);
  Stand(
      depth::MakeRoom({static_cast<float>(width_m), 2.6F, static_cast<float>(behind_m + before_m)}),
      {0, 0, (before_m - behind_m) / 2}, 0);
  if (scenario_.furnishing == Furnishing::kEmpty) return;
  for (const Way& way : ways_) {
    const Vector3d at_m = way.from_m;
    if (scenario_.furnishing == Furnishing::kSofa)
      Stand(depth::MakeSofa(1.6F, 0.75F, 0.42F), at_m - Vector3d(0, 0, 0.55), 0);
    if (scenario_.furnishing == Furnishing::kTable)
      Stand(depth::MakeTable({1.1F, 0.74F, 0.6F}), at_m + Vector3d(0, 0, 0.47), 0);
    if (scenario_.furnishing == Furnishing::kSofaBefore) StandSofaBefore(at_m, random);
    if (tight && scenario_.people > 1)  // a screen at each back
      Stand(depth::MakeBox({1.0F, 4.0F, 0.05F}), at_m - Vector3d(0, 0, 0.4), 0);
  }
  const size_t things = 2 + random.Index(4);
  for (size_t i = 0; i < things; ++i) {
    // Furniture along the rear wall, mostly at the sides, where nobody walks.
    const double side = random.Chance(0.5) ? 1 : -1;
    const double x_m = side * random.Uniform(scenario_.crossing ? 0.2 : 0.5, 0.5 * width_m);
    const double z_m = -behind_m + random.Uniform(0.2, scenario_.crossing ? 0.4 : 0.9);
    const bool free = std::all_of(ways_.begin(), ways_.end(), [&](const Way& way) {
      return scenario_.crossing || (way.from_m - Vector3d(x_m, 0, z_m)).norm() > 0.8;
    });
    const auto thing = SampleFurniture(random);
    if (free) Stand(thing, {x_m, 0, z_m}, random.Normal(0, 0.4));
  }
}

LabelledFrame IndoorSceneRenderer::RenderFrame(int64_t index) {
  if (inputs_.carried) MoveSensor(index);
  std::vector<TruthBody> bodies;
  for (size_t person = 0; person < bodies_.size(); ++person) {
    ClothedBody& body = bodies_[person];
    const auto pose = PoseAt(ways_[person], body.shape().root_scale, index);
    bodies.push_back({static_cast<int>(person) + 1, body.Pose(pose, camera_from_world_), {}});
    body.UpdateMesh(renderer_);
  }
  LabelledFrame frame = RenderBodies(renderer_, camera_, inputs_.model, bodies_,
                                     seed_ * 1000003 + static_cast<uint64_t>(index));
  frame.depth.index = index;
  frame.depth.time_s = static_cast<double>(index) / 30.0;
  frame.bodies = std::move(bodies);
  MarkVisibleJoints(&frame);
  return frame;
}

}  // namespace ossa::tools
