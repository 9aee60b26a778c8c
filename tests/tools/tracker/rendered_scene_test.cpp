// Clothed bodies as a Kinect sees them, of other sizes, behind furniture: tracked from depth images
// they play with the things of a scene.
#include <gtest/gtest.h>

#include <map>

#include "depth/render/shapes.h"
#include "recon/body/standard_body.h"
#include "recon/motion/authored.h"
#include "tests/tools/tracker/played_scenes.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/synth/clothed_body.h"

namespace ossa::tracker {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using recon::RigPose;
using test::Ease;

constexpr double kEye_m = 1.1;  // of the level camera above the floor
/// World: people around the origin face the camera, their left is at higher x.
const Vector3d kCamera_m(0.0, kEye_m, 2.8);

recon::BodyShape Small() { return {.age = 0.25, .height = 0.4}; }
recon::BodyShape Tall() { return {.male = 1.0, .height = 0.6}; }

/// Somebody and what they do.
struct Part {
  recon::BodyShape shape;
  Vector3d place_m = Vector3d::Zero();
  std::function<RigPose(double time_s)> motion;
};

/// Depth images of moving people in a room.
class RenderedScene {
 public:
  RenderedScene(std::vector<Part> parts, const std::vector<depth::TriangleMesh>& furniture)
      : parts_(std::move(parts)), model_(tools::LoadFetchedBody()), wardrobe_(model_) {
    const auto add = [&](const depth::TriangleMesh& mesh) {
      renderer_.AddMesh(depth::Moved(mesh, Eigen::Affine3f(from_world_.cast<float>())), false);
    };
    const Eigen::Affine3f ahead(
        Eigen::Translation3f(0.0F, 0.0F, 2.5F));  // wall 1.2 m behind people
    add(depth::Moved(depth::MakeRoom({5.0F, 2.6F, 7.4F}), ahead));
    for (const auto& mesh : furniture) add(mesh);
    for (const Part& part : parts_) {
      bodies_.emplace_back(model_, wardrobe_, part.shape, recon::Clothing{});
      bodies_.back().AddTo(renderer_);
    }
  }

  /// Joints of a person at a time, camera space, metres.
  recon::Posture PoseOf(size_t person, double time_s) {
    RigPose pose = parts_[person].motion(time_s);
    pose.root_m += parts_[person].place_m / bodies_[person].shape().root_scale;
    return bodies_[person].Pose(pose, from_world_);
  }
  depth::DepthFrame RenderFrame(int frame) {
    for (size_t k = 0; k < bodies_.size(); ++k) {
      PoseOf(k, frame / 30.0);
      bodies_[k].UpdateMesh(renderer_);
    }
    depth::DepthFrame shot = tools::RenderBodies(renderer_, depth::KinectV1Camera(320, 240), model_,
                                                 bodies_, static_cast<uint64_t>(frame) + 1)
                                 .depth;
    shot.index = frame;
    shot.time_s = frame / 30.0;
    return shot;
  }

 private:
  std::vector<Part> parts_;
  recon::BodyModel model_;
  recon::Wardrobe wardrobe_;
  Eigen::Isometry3d from_world_ = tools::LookAt(kCamera_m, {0.0, kEye_m, 0.0});
  depth::Renderer renderer_;
  std::vector<tools::ClothedBody> bodies_;
};

/// A cupboard before the legs of who stands there.
depth::TriangleMesh Cupboard(double x_m) {
  const Eigen::Affine3f there(Eigen::Translation3f(static_cast<float>(x_m), 0.25F, 0.75F));
  return depth::Moved(depth::MakeBox({0.7F, 0.5F, 0.3F}), there);
}

double HeightAboveFloor(const Vector3d& camera_m) { return camera_m.y() + kEye_m; }

/// What was seen, and the fastest that anything of it moved from frame to frame.
struct Played {
  test::Seen seen;
  double fastest_m_s = 0.0, lowest_m = 10.0;
};

using Watcher = std::function<void(const BodyFrame&, Scene&)>;

Played Track(RenderedScene& rendered, const SceneOptions& scene, int frames,
             const Watcher& watch = {}) {
  TrackerOptions options = PlainOptions();
  options.scene = scene;
  Tracker tracker(options);
  Played played;
  std::map<int, recon::Posture> before;
  for (int f = 0; f < frames; ++f) {
    const BodyFrame frame = tracker.Track(rendered.RenderFrame(f));
    played.seen.Update(*tracker.scene());
    for (const SceneObjectState& object : frame.objects) {
      EXPECT_TRUE(object.position_m.allFinite());
      played.lowest_m = std::min(played.lowest_m, HeightAboveFloor(object.position_m));
      played.fastest_m_s = std::max(played.fastest_m_s, object.velocity_m_s.norm());
    }
    for (const int character : tracker.scene()->world().Characters()) {
      const recon::Posture now = tracker.scene()->world().StateOf(character).posture;
      const auto then = before.find(character);
      for (size_t j = 0; then != before.end() && j < recon::kJointCount; ++j) {
        const double moved_m = (now.position_m[j] - then->second.position_m[j]).norm();
        played.fastest_m_s = std::max(played.fastest_m_s, 30.0 * moved_m);
      }
      before[character] = now;
    }
    if (watch) watch(frame, *tracker.scene());
  }
  return played;
}

// Limbs that follow noisy joints: over six seeds of the noise the box is pressed in by 2 to 14 mm,
// for a frame or two.
void ExpectSound(const Played& played) {
  constexpr double kDeepest_m = 0.02;
  EXPECT_TRUE(played.seen.is_finite);
  EXPECT_GT(played.lowest_m, 0.0);
  EXPECT_LT(played.fastest_m_s, 15.0);
  EXPECT_LT(played.seen.deepest_m, kDeepest_m);
}

#define OSSA_NEEDS_MODEL_AND_BODY() \
  OSSA_NEEDS_MODEL();               \
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body"

// ---- lifting

constexpr size_t kLeft = recon::Index(recon::Joint::kHandLeft);
constexpr size_t kRight = recon::Index(recon::Joint::kHandRight);

/// ossa's own clips of somebody who picks something up with both hands, level with each other. (Of
/// one whose right hand is 15 cm above the floor the tracker loses that hand before the shins.)
std::vector<recon::MotionClip> PickingUp() {
  constexpr double kLevel_m = 0.1;
  std::vector<recon::MotionClip> clips;
  for (recon::MotionClip& clip : recon::AuthoredClips({.seed = 1, .variations = 8})) {
    if (!clip.name.starts_with("authored/pick_up/")) continue;
    const auto level_m = [](const RigPose& pose) {
      const recon::Posture joints = recon::StandardPosture(pose);
      return joints.position_m[kLeft].y() - joints.position_m[kRight].y();
    };
    double most_m = 0.0;
    for (const RigPose& pose : clip.frames) most_m = std::max(most_m, std::abs(level_m(pose)));
    if (most_m < kLevel_m) clips.push_back(std::move(clip));
  }
  return clips;
}

/// When the hands are lowest, and where.
struct Grip {
  int frame = 0;
  Vector3d left_m, right_m;  // camera space
  double apart_m() const { return (left_m - right_m).norm(); }
};

Grip LowestGrip(RenderedScene& rendered, int frames) {
  Grip lowest;
  double lowest_m = 10.0;
  for (int f = 0; f < frames; ++f) {
    const recon::Posture joints = rendered.PoseOf(0, f / 30.0);
    const double sum_m = joints.position_m[kLeft].y() + joints.position_m[kRight].y();
    if (sum_m >= lowest_m) continue;
    lowest_m = sum_m;
    lowest = {f, joints.position_m[kLeft], joints.position_m[kRight]};
  }
  return lowest;
}

/// A box between the two hands, on something.
SceneOptions BoxIn(const Grip& grip) {
  const Vector3d middle_m = 0.5 * (grip.left_m + grip.right_m);
  const Vector3d across = grip.left_m - grip.right_m;
  SceneObject box;
  box.name = "box";
  box.body.size_m = {grip.apart_m() - 0.1, 0.16, 0.2};
  box.body.mass_kg = 1.5;
  box.body.position_m = {middle_m.x(), std::max(HeightAboveFloor(middle_m), 0.09), middle_m.z()};
  box.body.orientation = AngleAxisd(std::atan2(-across.z(), across.x()), Vector3d::UnitY());
  SceneObject stand = box;
  stand.name = "stand";
  stand.body.kind = physics::BodyKind::kStatic;
  const double height_m = std::max(0.01, box.body.position_m.y() - 0.081);
  stand.body.size_m = {0.1, height_m, 0.1};
  stand.body.position_m.y() = 0.5 * height_m;
  SceneOptions scene;
  scene.objects = {stand, box};
  GrabRule grab;
  grab.objects = {"box"};
  grab.hands = 2;
  grab.near_m = 0.2;  // as hands are tracked
  scene.grabs = {grab};
  return scene;
}

struct Lift {
  Played played;
  int grabbed = 0;                        // hands of person 1
  double start_m = 0.0, highest_m = 0.0;  // of the box, above the floor, while it is held
};

Lift PlayLift(const recon::MotionClip& clip, const recon::BodyShape& shape) {
  const auto motion = [&](double t) {
    return clip.frames[std::min(static_cast<size_t>(30.0 * t + 0.5), clip.frames.size() - 1)];
  };
  RenderedScene rendered({{shape, Vector3d::Zero(), motion}}, {});
  const auto frames = static_cast<int>(clip.frames.size());
  const Grip grip = LowestGrip(rendered, frames);
  const SceneOptions scene = BoxIn(grip);
  Lift lift;
  lift.start_m = scene.objects.back().body.position_m.y();
  lift.played = Track(rendered, scene, frames, [&](const BodyFrame& frame, Scene&) {
    if (frame.objects.empty()) return;
    const SceneObjectState& box = frame.objects.back();
    if (!box.held_by.empty()) {
      lift.highest_m = std::max(lift.highest_m, HeightAboveFloor(box.position_m));
    }
  });
  lift.grabbed = lift.played.seen.Count(SceneEvent::Kind::kGrabbed, 1);
  return lift;
}

TEST(RenderedScene, PeopleOfTwoSizesLiftABoxWithBothHands) {
  OSSA_NEEDS_MODEL_AND_BODY();
  const std::vector<recon::MotionClip> clips = PickingUp();
  ASSERT_GE(clips.size(), 2U);
  for (size_t k = 0; k < 2; ++k) {
    const Lift lift = PlayLift(clips[k], k == 0 ? Tall() : Small());
    ExpectSound(lift.played);
    EXPECT_EQ(lift.grabbed, 2) << clips[k].name;
    EXPECT_GT(lift.highest_m, lift.start_m + 0.25) << clips[k].name;
  }
}

// ---- throwing

/// Standing, with arms turned up sideways from where they hang off the rig's rest.
RigPose ArmsLifted(double left_rad, double right_rad) {
  constexpr size_t kLeftArm = 18, kRightArm = 25;  // of kRigBoneNames
  constexpr size_t kArmBones = 6;                  // and what hangs on it
  RigPose pose;
  pose.root_m = recon::StandardRigRest().head_m[0];
  for (size_t k = 0; k < kArmBones; ++k) {
    pose.world_from_rest[kLeftArm + k] = AngleAxisd(left_rad, Vector3d::UnitZ());
    pose.world_from_rest[kRightArm + k] = AngleAxisd(-right_rad, Vector3d::UnitZ());
  }
  return pose;
}

/// One swings the right arm up sideways, towards the other, who holds the left one out.
std::vector<Part> Throwers(const recon::BodyShape& first, const recon::BodyShape& second,
                           double apart_m, double catching_rad) {
  const auto throwing = [](double t) { return ArmsLifted(-0.4, -0.7 + 1.5 * Ease(t, 1.5, 1.8)); };
  const auto catching = [=](double) { return ArmsLifted(catching_rad, -0.4); };
  // Who throws stands on the camera's right, at lower x of its space.
  return {{first, {0.5 * apart_m, 0.0, 0.0}, throwing},
          {second, {-0.5 * apart_m, 0.0, 0.0}, catching}};
}

/// A ball in the hand of who throws, that whoever is near takes, in flight, too.
SceneOptions BallAt(const Vector3d& hand_m) {
  SceneOptions scene;
  SceneObject ball = test::MakeBall(0.16, 0.4);
  ball.body.position_m = {hand_m.x() + 0.11, HeightAboveFloor(hand_m) - 0.09, hand_m.z()};
  scene.objects = {ball};
  GrabRule grab;
  grab.near_m = 0.25;
  grab.slower_m_s = 8.0;
  scene.grabs = {grab};
  ThrowRule toss;
  toss.faster_m_s = 1.5;
  scene.throws = {toss};
  return scene;
}

/// Who throws and who takes it afterwards, by ids; 0: nobody.
struct Throw {
  Played played;
  int from = 0, to = 0;
};

Throw PlayThrow(RenderedScene& rendered) {
  const Vector3d hand_m = rendered.PoseOf(0, 0.0).position_m[kRight];
  Throw made;
  made.played = Track(rendered, BallAt(hand_m), 85, [&](const BodyFrame&, Scene& scene) {
    for (const SceneEvent& event : scene.events()) {
      if (event.kind == SceneEvent::Kind::kThrown && made.from == 0) made.from = event.body;
      if (event.kind == SceneEvent::Kind::kGrabbed && made.from != 0 && made.to == 0) {
        made.to = event.body;
      }
    }
  });
  return made;
}

TEST(RenderedScene, OneThrowsABallToAnotherOfAnotherSizeBehindACupboard) {
  OSSA_NEEDS_MODEL_AND_BODY();
  RenderedScene down(Throwers(Tall(), Small(), 2.0, 0.3), {Cupboard(-1.0)});
  RenderedScene up(Throwers(Small(), Tall(), 1.15, -0.3), {Cupboard(-0.575)});
  for (RenderedScene* const rendered : {&down, &up}) {
    const Throw made = PlayThrow(*rendered);
    ExpectSound(made.played);
    EXPECT_NE(made.from, 0);
    EXPECT_NE(made.to, 0);
    EXPECT_NE(made.from, made.to);
  }
}

// ---- dodging

TEST(RenderedScene, ChildWithHiddenLegsDodgesABall) {
  OSSA_NEEDS_MODEL_AND_BODY();
  SceneOptions scene;
  SceneObject ball = test::MakeBall(0.2, 0.2);
  ball.origin = SceneObject::Origin::kPerson;
  for (const bool dodges : {false, true}) {
    RenderedScene rendered(
        {{Small(), Vector3d::Zero(), [](double) { return ArmsLifted(-0.4, -0.4); }}},
        {Cupboard(0.0)});
    const recon::Posture truth = rendered.PoseOf(0, 0.0);
    ball.body.position_m = {0.0, HeightAboveFloor(truth[recon::Joint::kHead]), 2.0};
    ball.body.velocity_m_s = {0.0, 0.4 * 0.5 * 9.81, -2.0 / 0.4};  // at the head in 0.4 s
    scene.objects = {ball};
    if (dodges) scene.dodge = DodgeRule{};
    int hits = 0;
    const Played played = Track(rendered, scene, 45, [&](const BodyFrame&, Scene& world) {
      for (const physics::Strike& strike : world.world().Contacts().struck) {
        hits += strike.bone <= recon::Index(recon::Joint::kHead) ? 1 : 0;
      }
    });
    ExpectSound(played);
    EXPECT_EQ(hits > 0, !dodges);
  }
}

}  // namespace
}  // namespace ossa::tracker
