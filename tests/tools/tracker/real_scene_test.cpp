// Recorded people in a scene with objects.
#include "tools/tracker/scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "recon/files/skeleton_io.h"
#include "tests/support/places.h"
#include "tests/tools/tracker/played_scenes.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::HoldersOf;
using test::kOverlap_m;
using test::PlaceOf;
using test::Play;
using test::Seen;

/// A recording moved so that its feet are on y = 0 and its hips initially at a place of the floor;
/// scaled, and without some joints.
recon::SkeletonSequence Staged(recon::SkeletonSequence recording, const Vector3d& place_m,
                               double scale, std::initializer_list<Joint> missing) {
  double lowest_m = 10.0;
  std::optional<Vector3d> hips;
  for (auto& frame : recording.frames) {
    for (auto& joint : frame.bodies.at(0).joints) {
      if (!joint) continue;
      joint->position_m *= scale;
      if (!hips) hips = joint->position_m;
      lowest_m = std::min(lowest_m, joint->position_m.y());
    }
  }
  const Vector3d by_m = place_m - Vector3d(hips->x(), lowest_m, hips->z());
  for (auto& frame : recording.frames) {
    for (auto& joint : frame.bodies[0].joints) {
      if (joint) joint->position_m += by_m;
    }
    for (const Joint joint : missing) frame.bodies[0].joints[recon::Index(joint)].reset();
  }
  return recording;
}

// A box on a table in front of each of the first two people.
SceneOptions BoxesOnTables() {
  SceneOptions options;
  options.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  for (const int person : {1, 2}) {
    SceneObject box;
    box.name = "box " + std::to_string(person);
    box.body.size_m = person == 1 ? Vector3d(0.9, 0.12, 0.12) : Vector3d(0.26, 0.1, 0.1);
    box.body.mass_kg = 0.3;
    box.origin = SceneObject::Origin::kPerson;
    box.person = person;
    box.body.position_m = person == 1 ? Vector3d(0.0, 1.06, 0.4) : Vector3d(0.05, 0.43, 0.35);
    SceneObject table = box;
    table.name = "table " + std::to_string(person);
    table.body.kind = physics::BodyKind::kStatic;
    const double height_m = box.body.position_m.y() - 0.5 * box.body.size_m.y() - 0.001;
    table.body.size_m = {0.1, height_m, 0.1};
    table.body.position_m.y() = 0.5 * height_m;
    options.objects.push_back(box);
    options.objects.push_back(table);
  }
  options.grabs = {GrabRule{}};
  options.releases = {ReleaseRule{}};
  options.dodge = DodgeRule{};
  return options;
}

// Recorded by a Kinect v2: a person without recorded hands squats, and a patient raises both arms
// from the hips.
TEST(RealScene, PatientsOfOtherSizesWithMissingJointsShareAWorldWithObjects) {
  const auto real = ossa::test::SharedFolder() / "real";
  if (!std::filesystem::exists(real)) GTEST_SKIP() << real << " is not there";
  const auto first =
      Staged(recon::ReadSkeletons(
                 real / "uiprmd_kinect_vicon/raw_e05.tar.gz#Kinect_Positions/m01_s10_e05"),
             {-0.7, 0.0, 2.5}, 1.0, {});
  const auto second = Staged(
      recon::ReadSkeletons(real / "keraal_kinect_vicon/pairs/G3-Kinect-CTK-P1T1-Unknown-C-0.txt"),
      {0.7, 0.0, 2.5}, 0.75, {Joint::kFootLeft, Joint::kAnkleLeft, Joint::kHandLeft});
  Scene scene(BoxesOnTables());
  Seen seen;
  const size_t frames = std::min<size_t>(300, std::min(first.frames.size(), second.frames.size()));
  for (size_t f = 0; f < frames; ++f) {
    recon::SkeletonFrame frame;
    frame.time_s = static_cast<double>(f) / 30.0;
    frame.bodies = {first.frames[f].bodies[0], second.frames[f].bodies[0]};
    frame.bodies[0].id = 1;
    frame.bodies[1].id = 2;
    if (f % 40 == 39) frame.bodies.pop_back();  // lost for a frame
    scene.Play(frame);
    seen.Update(scene);
    for (const recon::BodyRecord& body : frame.bodies) {
      for (const auto& joint : body.joints) ASSERT_TRUE(joint && joint->position_m.allFinite());
    }
    for (const int character : scene.world().Characters()) {
      ASSERT_EQ(scene.world().StateOf(character).rescued, 0) << f;
    }
  }
  EXPECT_GT(frames, 60U);
  EXPECT_EQ(scene.objects().size(), 4U);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
  EXPECT_TRUE(seen.is_finite);
}

/// A flat box just above a person's hands in the first frame.
SceneOptions BoxAtHandsOf(const recon::BodyRecord& body) {
  const Vector3d left = body.joints[recon::Index(Joint::kHandLeft)].value().position_m;
  const Vector3d right = body.joints[recon::Index(Joint::kHandRight)].value().position_m;
  const Vector3d across = left - right;
  SceneObject box;
  box.name = "box";
  box.body.size_m = {across.norm() - 0.06, 0.06, 0.1};
  box.body.mass_kg = 0.5;
  box.body.position_m = 0.5 * (left + right) + Vector3d(0.0, 0.1, 0.0);
  box.body.orientation = Eigen::AngleAxisd(std::atan2(-across.z(), across.x()), Vector3d::UnitY());
  SceneOptions scene;
  scene.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  scene.objects = {box};
  GrabRule grab;
  grab.hands = 2;
  scene.grabs = {grab};
  scene.releases = {ReleaseRule{}};
  return scene;
}

// A KERAAL patient who first waits with a box at the hands, then raises both arms and spreads them.
TEST(RealScene, HandsOfKeraalLiftABoxAndReleaseItWhereTheySpread) {
  const auto keraal = ossa::test::SharedFolder() / "real/keraal_kinect_vicon/pairs";
  if (!std::filesystem::exists(keraal)) GTEST_SKIP() << keraal << " is not there";
  const auto patient = Staged(recon::ReadSkeletons(keraal / "G3-Kinect-CTK-P1T1-Unknown-C-0.txt"),
                              {0.0, 0.0, 2.5}, 1.0, {});
  const recon::BodyRecord& first = patient.frames.at(0).bodies.at(0);
  const SceneOptions options = BoxAtHandsOf(first);
  const double start_m = options.objects.back().body.position_m.y();
  constexpr size_t kWaits = 20, kFrames = 90;
  ASSERT_GT(patient.frames.size(), kFrames - kWaits);
  Scene scene(options);
  Seen seen;
  double highest_m = 0.0;
  for (size_t f = 0; f < kFrames; ++f) {
    recon::SkeletonFrame frame = patient.frames[f < kWaits ? 0 : f - kWaits];
    frame.time_s = static_cast<double>(f) / 30.0;
    scene.Play(frame);
    seen.Update(scene);
    if (HoldersOf(scene, "box").empty()) continue;
    highest_m = std::max(highest_m, PlaceOf(scene, "box").y());
  }
  EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, first.id), 2);
  EXPECT_GT(seen.Count(SceneEvent::Kind::kReleased, first.id), 0);
  EXPECT_GT(highest_m, start_m + 0.3);
  EXPECT_LT(PlaceOf(scene, "box").y(), start_m);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
  EXPECT_TRUE(seen.is_finite);
}

}  // namespace
}  // namespace ossa::tracker
