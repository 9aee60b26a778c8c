#include "tools/synth/frame_maker.h"

#include <algorithm>
#include <cmath>

#include "depth/render/renderer.h"
#include "tools/synth/accessories.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/distractors.h"
#include "tools/synth/draw_scene_internal.h"
#include "tools/synth/frame_truth_internal.h"
#include "tools/synth/interaction.h"
#include "tools/synth/materials.h"
#include "tools/synth/pixel_box_internal.h"
#include "tools/synth/sample_person.h"
#include "tools/synth/shrunk_frame.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand unless stated otherwise.

constexpr int64_t kFramesPerBody = 8;  // for speed: a new body costs as much as the rest of a frame
constexpr int kMostTries = 24;         // draws of a view, until enough of the person is visible
constexpr double kRoomShare = 0.8;     // share of frames with a wall behind the person's outline
constexpr double kTrustedGap_m = 0.25;  // feet farther above the floor: a jump

// Streams of random numbers: draws of one kind must not shift those of another.
enum Stream : uint64_t {
  kBodyStream = 1,
  kSceneStream = 2,
  kNoiseStream = 3,
  kThingStream = 4,
  kSensorStream = 5
};

Random SeedStream(uint64_t seed, Stream purpose, int64_t index, int extra) {
  // The high bits that the shift loses must count, else two seeds would be equal.
  const uint64_t pushed_out = seed >> 61U;
  const uint64_t purposeful = pushed_out == 0 ? seed * 8 + purpose : MixSeed(seed, purpose);
  return Random(purposeful, static_cast<uint64_t>(index) * 64 + static_cast<uint64_t>(extra));
}

struct ClothedPerson {
  int64_t key = -1;
  recon::ShapedBody body;
  recon::Clothing clothing;
  Accessories accessories;
  std::vector<Eigen::Vector3f> rest_m;
};

}  // namespace

struct FrameMaker::State {
  const FrameInputs& inputs;
  const FrameOptions& options;
  depth::Renderer renderer;
  std::vector<ClothedPerson> clothed_people;  // one per person
  std::vector<std::vector<Eigen::Vector3f>> posed_m;
  std::vector<int> mesh_of_person;
  std::vector<recon::Posture> path_in_world;  // for a sequence: the first person in all frames

  explicit State(const FrameInputs& shared) : inputs(shared), options(shared.options) {
    const auto people = static_cast<size_t>(options.people);
    clothed_people.resize(people);
    posed_m.assign(people, std::vector<Eigen::Vector3f>(inputs.model.vertex_count()));
    for (size_t person = 0; person < people; ++person) {
      // The renderer builds its tree from the rest pose and only refits it afterwards.
      Dress(0, static_cast<int>(person));
      mesh_of_person.push_back(
          renderer.AddMesh({clothed_people[person].rest_m, inputs.model.triangles()}, true));
    }
  }

  void Dress(int64_t index, int person);
  recon::Posture Pose(const recon::RigPose& pose, size_t person,
                      const Eigen::Isometry3d& camera_from_world);
  recon::RigPose DrawPose(int64_t index, Random& random) const;
  std::vector<Prop> DrawProps(const recon::Posture& joints_in_cam, const PeopleScene& scene,
                              Random& random);
  std::vector<Prop> DrawPropsFor(const ViewSample& view, const recon::Posture& joints_in_cam,
                                 const PeopleScene& scene, Random& random);
  std::vector<Prop> DrawInteractionProps(Interaction interaction,
                                         const recon::Posture& joints_in_cam,
                                         const ViewSample& view, Random& random) const;
  // People posed in camera space.
  struct PosedPeople {
    Interaction interaction = Interaction::kNone;  // of the first person
    std::vector<TruthBody> bodies{};
    std::vector<Prop> things{};  // their accessories, in camera space
    PixelBox box{};              // around them, pixels
  };
  PosedPeople PosePeople(int64_t index, const PeopleScene& scene, const ViewSample& view,
                         Random& random, Random& thing);
  std::optional<LabelledFrame> TryMake(int64_t index, int attempt);
  depth::SensorModel DrawSensor(int64_t index) const;
  LabelledFrame RenderFrame(const ViewSample& view, const std::vector<Prop>& props,
                            const PixelBox& box, int64_t index, uint64_t noise_seed);
};

void FrameMaker::State::Dress(int64_t index, int person) {
  const int64_t key = options.sequence ? 0 : index / kFramesPerBody;
  ClothedPerson& clothed = clothed_people[static_cast<size_t>(person)];
  if (clothed.key == key) return;
  Random random = SeedStream(options.seed, kBodyStream, key, person);
  if (options.random_bodies) {
    clothed.body = inputs.model.Shape(options.ends ? SampleAnyShape(options.split, random)
                                                   : SampleShape(options.split, random));
    clothed.clothing =
        options.hanging_clothes ? SampleHangingClothing(random) : SampleClothing(random);
    if (options.hanging_clothes) {
      clothed.accessories = SampleAccessories(random);
      clothed.clothing.glove_m = SampleGloves_m(random);
    }
  } else {
    clothed.body = inputs.model.Shape({});
    clothed.clothing = {};
  }
  clothed.rest_m = inputs.wardrobe.Dress(clothed.body, clothed.clothing);
  clothed.key = key;
}

// Skins the person into camera space, feet on the floor; returns the joints in camera space.
recon::Posture FrameMaker::State::Pose(const recon::RigPose& pose, size_t person,
                                       const Eigen::Isometry3d& camera_from_world) {
  const ClothedPerson& clothed = clothed_people[person];
  auto& posed = posed_m[person];
  inputs.model.Skin(clothed.body, clothed.rest_m, pose, camera_from_world, posed);
  recon::Posture joints = recon::ComputeJoints(clothed.body, pose);
  for (auto& joint_m : joints.position_m) joint_m = camera_from_world * joint_m;
  const Eigen::Vector3f inside_m = joints[recon::Joint::kHipCenter].cast<float>();
  inputs.wardrobe.HideUnworn(clothed.clothing, inside_m, posed);
  const Eigen::Isometry3d world_from_camera = camera_from_world.inverse();
  const Eigen::Vector3f up = world_from_camera.linear().row(1).transpose().cast<float>();
  float lowest_m = 1e9f;
  for (const auto& p : posed) lowest_m = std::min(lowest_m, up.dot(p));
  lowest_m += static_cast<float>(world_from_camera.translation().y());
  const bool jump = options.sequence ? lowest_m > 0 : lowest_m > kTrustedGap_m;
  const Eigen::Vector3f lift = jump ? Eigen::Vector3f::Zero() : Eigen::Vector3f(-lowest_m * up);
  for (auto& p : posed) p += lift;
  for (auto& joint_m : joints.position_m) joint_m += lift.cast<double>();
  return joints;
}

recon::RigPose FrameMaker::State::DrawPose(int64_t index, Random& random) const {
  const auto& poses = inputs.poses;
  if (options.sequence) {
    // A clip shorter than the sequence is played forwards and backwards.
    const auto period = std::max<int64_t>(1, 2 * static_cast<int64_t>(poses.size()) - 2);
    const int64_t at = index % period;
    return poses[static_cast<size_t>(std::min(at, period - at))];
  }
  return Varied(poses[random.Index(poses.size())], options.variation, random);
}

// Occluders, held objects and the room. In a sequence the first frame determines them: room and
// standing objects stay in place, held objects move with the hands.
std::vector<Prop> FrameMaker::State::DrawProps(const recon::Posture& joints_in_cam,
                                               const PeopleScene& scene, Random& random) {
  const ViewSample& view = scene.view;
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  recon::Posture joints_in_world = joints_in_cam;
  for (auto& joint_m : joints_in_world.position_m) joint_m = world_from_camera * joint_m;
  if (options.sequence && path_in_world.empty()) {
    for (const recon::RigPose& pose : inputs.poses) {
      path_in_world.push_back(
          recon::ComputeJoints(clothed_people[0].body, Turned(pose, view.facing_rad)));
    }
  }
  std::vector<Prop> props;
  if (options.sequence) {
    recon::Posture first_in_cam = path_in_world[0];
    for (auto& joint_m : first_in_cam.position_m) joint_m = view.camera_from_world * joint_m;
    for (Prop& prop :
         SampleLastingProps(options.occluders, path_in_world, view.camera_from_world, random)) {
      props.push_back(Carried(std::move(prop), first_in_cam, joints_in_cam));
    }
  } else {
    props = SampleProps(options.occluders, joints_in_world, view.camera_from_world, random);
  }
  if (options.background != Background::kNone || random.Chance(kRoomShare)) {
    std::vector<Eigen::Vector3d> others_m;
    for (size_t k = 1; k < scene.cameras_from_world.size(); ++k) {
      others_m.emplace_back(scene.cameras_from_world[k].inverse().translation());
    }
    for (Prop& prop : SampleRoom(view.camera_from_world, random, path_in_world, others_m))
      props.push_back(std::move(prop));
  }
  return props;
}

// DrawProps() in the space of the view's camera; camera 0 determines which props exist.
std::vector<Prop> FrameMaker::State::DrawPropsFor(const ViewSample& view,
                                                  const recon::Posture& joints_in_cam,
                                                  const PeopleScene& scene, Random& random) {
  if (options.camera == 0) return DrawProps(joints_in_cam, scene, random);
  const Eigen::Isometry3d from_camera_0 =
      view.camera_from_world * scene.view.camera_from_world.inverse();
  recon::Posture joints_in_camera_0 = joints_in_cam;
  for (auto& joint_m : joints_in_camera_0.position_m) joint_m = from_camera_0.inverse() * joint_m;
  std::vector<Prop> props = DrawProps(joints_in_camera_0, scene, random);
  MoveToCamera(from_camera_0, props);
  return props;
}

// Objects of the interaction, and distractors, besides DrawProps().
std::vector<Prop> FrameMaker::State::DrawInteractionProps(Interaction interaction,
                                                          const recon::Posture& joints_in_cam,
                                                          const ViewSample& view,
                                                          Random& random) const {
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  recon::Posture joints_in_world = joints_in_cam;
  for (auto& joint_m : joints_in_world.position_m) joint_m = world_from_camera * joint_m;
  std::vector<Prop> props =
      InteractionProps(interaction, joints_in_world, view.camera_from_world, random);
  if (options.background == Background::kLivedIn) {
    for (Prop& prop : SampleDistractors(view.camera_from_world, random))
      props.push_back(std::move(prop));
  }
  return props;
}

depth::SensorModel FrameMaker::State::DrawSensor(int64_t index) const {
  if (options.sensors.size() == 1) return depth::MakeSensorModel(options.sensors[0]);
  Random random = SeedStream(options.seed, kSensorStream, options.sequence ? 0 : index, 0);
  return depth::MakeSensorModel(options.sensors[random.Index(options.sensors.size())]);
}

// Renders, simulates the sensor, labels. The image is the crop `box` of the view.
LabelledFrame FrameMaker::State::RenderFrame(const ViewSample& view, const std::vector<Prop>& props,
                                             const PixelBox& box, int64_t index,
                                             uint64_t noise_seed) {
  std::vector<int> prop_mesh;
  for (const Prop& prop : props) prop_mesh.push_back(renderer.AddMesh(prop.mesh_in_cam, false));
  depth::Camera crop = view.camera;
  crop.width = box.u1 - box.u0 + 1;
  crop.height = box.v1 - box.v0 + 1;
  crop.cx -= box.u0;
  crop.cy -= box.v0;
  const depth::SensorModel sensor = DrawSensor(index);
  depth::RenderedImage seen = renderer.Render(crop, depth::RaysFor(sensor));
  for (const int mesh : prop_mesh) renderer.RemoveMesh(mesh);
  if (std::holds_alternative<depth::TimeOfFlightOptions>(sensor)) {
    const int64_t body = options.sequence ? 0 : index / kFramesPerBody;
    seen.reflectance =
        DrawReflectance(seen, inputs.model, mesh_of_person,
                        MixSeed(options.seed, kSensorStream, static_cast<uint64_t>(body)));
  }
  depth::SensorImage sensed = depth::Simulate(sensor, seen, crop, view.camera, noise_seed);

  LabelledFrame frame;
  frame.depth.camera = crop;
  LabelPeople(seen, sensed, inputs.model, mesh_of_person, &frame);
  LabelProps(seen, props, prop_mesh, options.background, &sensed, &frame);
  frame.depth.depth_mm = std::move(sensed.depth_mm.data);
  if (view.shrink > 1.0) {
    frame = ShrunkFrame(frame, box.u0, box.v0, view.shrink, ShrunkCamera(view.camera, view.shrink));
  }
  if (options.cameras == Cameras::kAny) frame.whole = ShrunkCamera(view.camera, view.shrink);
  return frame;
}

// Poses all people in camera space, with their accessories.
FrameMaker::State::PosedPeople FrameMaker::State::PosePeople(int64_t index,
                                                             const PeopleScene& scene,
                                                             const ViewSample& view, Random& random,
                                                             Random& thing) {
  PosedPeople posed{.interaction = DrawInteraction(options.occluders, thing)};
  for (size_t person = 0; person < scene.places_m.size(); ++person) {
    const ClothedPerson& clothed = clothed_people[person];
    const double heading_rad =
        person == 0 ? view.facing_rad : view.facing_rad + random.Uniform(-1.5, 1.5);
    recon::RigPose pose = DrawPose(index, random);
    if (person == 0) posed.interaction = ArrangeArms(posed.interaction, &pose, thing);
    pose = Turned(pose, heading_rad);
    if (!options.sequence) {
      const double right = random.Uniform(0, 1), left = random.Uniform(0, 1);
      recon::CloseHands(clothed.body, left, right, &pose);
    }
    pose.root_m += scene.places_m[person] / clothed.body.root_scale;
    const auto id = static_cast<uint8_t>(person + 1);
    posed.bodies.push_back({id, Pose(pose, person, view.camera_from_world), {}});
    for (Prop& prop : AccessoryProps(clothed.accessories, pose, posed.bodies.back().joints_m,
                                     clothed.body.height_m, view.camera_from_world, id)) {
      posed.things.push_back(std::move(prop));
    }
    renderer.UpdateVertices(mesh_of_person[person], posed_m[person]);
    posed.box = Union(posed.box, BoundingBoxOf(posed_m[person], view.camera));
  }
  return posed;
}

std::optional<LabelledFrame> FrameMaker::State::TryMake(int64_t index, int attempt) {
  const int64_t drawn_for = options.sequence ? 0 : index;  // a sequence draws its scene once
  Random random = SeedStream(options.seed, kSceneStream, drawn_for, attempt);
  for (int person = 0; person < options.people; ++person) Dress(index, person);
  const PeopleScene scene = DrawScene(options, clothed_people[0].body.height_m, random);
  ViewSample view = scene.view;
  view.camera_from_world = scene.cameras_from_world[static_cast<size_t>(options.camera)];
  Random thing = SeedStream(options.seed, kThingStream, drawn_for, attempt);
  PosedPeople posed = PosePeople(index, scene, view, random, thing);
  // Nobody in view: another view is drawn, but a sequence keeps its view.
  const bool unseen = posed.box.u1 - posed.box.u0 < 2 || posed.box.v1 - posed.box.v0 < 2;
  const bool room = options.background != Background::kNone;
  if (unseen && !options.sequence && !room) return std::nullopt;

  const recon::Posture& joints_in_cam = posed.bodies[0].joints_m;
  for (Prop& prop : DrawInteractionProps(posed.interaction, joints_in_cam, view, thing)) {
    posed.things.push_back(std::move(prop));
  }
  PixelBox box = posed.box;
  for (const Prop& prop : posed.things) {
    box = Union(box, BoundingBoxOf(prop.mesh_in_cam.vertices_m, view.camera));
  }
  if (room || (unseen && options.sequence)) {
    box = {0, 0, view.camera.width - 1, view.camera.height - 1};
  }
  std::vector<Prop> props = DrawPropsFor(view, joints_in_cam, scene, random);
  for (Prop& prop : posed.things) props.push_back(std::move(prop));
  const uint64_t noise_seed = SeedStream(options.seed, kNoiseStream, index, attempt).Bits();
  LabelledFrame frame =
      RenderFrame(view, props, box, index,
                  options.camera == 0 ? noise_seed
                                      : MixSeed(noise_seed, static_cast<uint64_t>(options.camera)));
  AddTruth(std::move(posed.bodies), view, index, &frame);
  return frame;
}

depth::Camera MakeCamera(const FrameOptions& options) {
  const ViewRequest request{.width = options.width,
                            .height = options.height,
                            .fov_deg = options.fov_deg,
                            .shrink = options.shrink};
  return ShrunkCamera(PlainCamera(request), options.shrink);
}

std::vector<Eigen::Isometry3d> FrameMaker::FromCamera0() {
  Random random = SeedStream(state_->options.seed, kSceneStream, 0, 0);
  const PeopleScene scene =
      DrawScene(state_->options, state_->clothed_people[0].body.height_m, random);
  std::vector<Eigen::Isometry3d> all{Eigen::Isometry3d::Identity()};
  for (size_t k = 1; k < scene.cameras_from_world.size(); ++k) {
    all.push_back(scene.cameras_from_world[k] * scene.view.camera_from_world.inverse());
  }
  return all;
}

FrameMaker::FrameMaker(const FrameInputs& inputs) : state_(std::make_unique<State>(inputs)) {}
FrameMaker::~FrameMaker() = default;

LabelledFrame FrameMaker::Make(int64_t index) {
  std::optional<LabelledFrame> frame;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    auto next = state_->TryMake(index, attempt);
    if (!next) continue;
    frame = std::move(next);
    if (state_->options.sequence || ShowsEnough(*frame, state_->options)) break;
  }
  if (!frame) throw std::runtime_error("no view of frame " + std::to_string(index));
  return std::move(*frame);
}

}  // namespace ossa::tools
