// People and objects of a scene in one mechanical world.
#include "tools/tracker/scene.h"

#include <gtest/gtest.h>

#include <optional>
#include <sstream>

#include "recon/files/skeleton_jsonl.h"
#include "tests/tools/tracker/played_scenes.h"
#include "tools/tracker/scene_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::HoldersOf;
using test::kOverlap_m;
using test::Lifting;
using test::PlaceOf;
using test::Play;
using test::Seen;

TEST(Scene, ContinuesWhenPeopleLeaveAndTheirObjectsFall) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  const auto leaving = [&](double t) {
    auto people = lifting(t);
    if (t > 5.0) people.clear();
    return people;
  };
  const Seen seen = Play(scene, leaving, 7.0);
  EXPECT_EQ(scene.CharacterOf(1), std::nullopt);
  EXPECT_TRUE(scene.world().Characters().empty());
  EXPECT_LT(PlaceOf(scene, "box").y(), -1.0 + test::kTable_m + 0.2);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

TEST(Scene, HoldsSurviveANewCharacter) {
  Lifting lifting, taller;
  taller.first_height_m = 1.8;  // 3 % more: another character
  Scene scene(lifting.Options());
  std::optional<int> character;
  const auto people = [&](double t) { return t < 4.3 ? lifting(t) : taller(t); };
  const Seen seen =
      Play(scene, people, 5.5, [&](double t, const recon::SkeletonFrame&, Scene& played) {
        if (t < 4.3) character = played.CharacterOf(1);
      });
  EXPECT_NE(scene.CharacterOf(1), character);
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
  for (const int body : {1, 2}) {
    EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, body), 1) << body;
    EXPECT_EQ(seen.Count(SceneEvent::Kind::kReleased, body), 0) << body;
  }
}

TEST(Scene, CompletesMissingJoints) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  for (int f = 0; f < 120; ++f) {
    recon::SkeletonFrame frame = test::SkeletonsOf(lifting(f / 30.0), f);
    for (auto& joint : frame.bodies[0].joints) {
      const auto j = static_cast<size_t>(&joint - frame.bodies[0].joints.data());
      if (j == 0 || j >= 12 || (f % 3 == 0 && j == 9)) joint.reset();  // hips, legs; an elbow
    }
    if (f % 7 == 0) frame.bodies[1].joints = {};  // nothing is known of the other
    scene.Play(frame);
    for (const auto& joint : frame.bodies[0].joints) {
      ASSERT_TRUE(joint.has_value());
      ASSERT_TRUE(joint->position_m.allFinite());
      ASSERT_LT(joint->position_m.norm(), 4.0);
    }
  }
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
}

TEST(Scene, RestartsWhenTimeRunsBackwards) {
  const Lifting lifting;
  Scene scene(lifting.Options()), fresh(lifting.Options());
  Play(scene, lifting, 4.0);
  Play(scene, lifting, 1.0);
  Play(fresh, lifting, 1.0);
  EXPECT_EQ(PlaceOf(scene, "box"), PlaceOf(fresh, "box"));
}

TEST(Scene, ContinuesWhenTimesRepeatOrJitter) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  for (int f = 0; f < 120; ++f) {
    recon::SkeletonFrame frame = test::SkeletonsOf(lifting(f / 30.0), f);
    if (f % 6 == 5) frame.time_s -= 1 / 30.0 + (f % 12 == 5 ? 0.002 : 0.0);
    scene.Play(frame);
  }
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
  EXPECT_TRUE(PlaceOf(scene, "box").allFinite());
}

// After a gap somebody is put elsewhere, and goes on holding what they hold.
TEST(HandMemory, ForgetsMotionButKeepsTheGrip) {
  HandMemory hand;
  hand.held_at_m = 0.07;
  hand.taken_by.near_m = 0.3;
  hand.away_s = 0.2;
  hand.made_m = Vector3d::UnitY();
  for (int f = 0; f < 4; ++f) hand.See(f / 30.0, Vector3d(0.1 * f, 0, 0));
  ASSERT_GT(hand.SteadyVelocity_m_s().x(), 2.9);
  hand.ResetMotion();
  EXPECT_EQ(hand.held_at_m, 0.07);
  EXPECT_EQ(hand.taken_by.near_m, 0.3);
  EXPECT_EQ(hand.away_s, 0.0);
  EXPECT_FALSE(hand.made_m.has_value());
  EXPECT_EQ(hand.seen_velocity_m_s, Vector3d::Zero());
  hand.See(9.0, Vector3d(5, 0, 0));
  EXPECT_EQ(hand.seen_velocity_m_s, Vector3d::Zero());
}

// Things would wait for it for ever.
TEST(Scene, RefusesAnInvalidFloor) {
  SceneOptions options = Lifting().Options();
  options.floor = test::Ground();
  EXPECT_NO_THROW(options.Check());
  options.floor->y() = 0.0;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options.floor = Eigen::Vector4d(0.0, 1.0, 0.0, std::nan(""));
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

TEST(Scene, WaitsForAFloor) {
  Scene scene(Lifting{}.Options());
  recon::SkeletonFrame frame = test::SkeletonsOf(Lifting{}(0.0), 0);
  frame.floor.reset();
  for (int f = 0; f < 30; ++f) {
    frame.time_s = f / 30.0;
    scene.Play(frame);
  }
  EXPECT_FALSE(scene.has_floor());
  EXPECT_TRUE(scene.objects().empty());
}

TEST(Scene, PlacesObjectsRelativeToAPerson) {
  SceneOptions options;
  SceneObject ball;
  ball.name = "ball";
  ball.body.shape = physics::Shape::kBall;
  ball.body.size_m.setConstant(0.1);
  ball.body.kind = physics::BodyKind::kStatic;
  ball.origin = SceneObject::Origin::kPerson;
  ball.person = 2;
  ball.body.position_m = {0.3, 1.0, 0.5};  // to the left, in front
  options.objects = {ball};
  Scene scene(options);
  Play(scene, Lifting{}, 1.0);
  // Who faces the camera has their left at lower x, and before them is nearer.
  const recon::Posture second = tests::ComputeJoints(Lifting{}(0.0)[1]);
  const Vector3d wanted = second[Joint::kHipCenter] + Vector3d(-0.3, 0.0, -0.5);
  EXPECT_NEAR(PlaceOf(scene, "ball").x(), wanted.x(), 0.03);
  EXPECT_NEAR(PlaceOf(scene, "ball").y(), 0.0, 0.001);
  EXPECT_NEAR(PlaceOf(scene, "ball").z(), wanted.z(), 0.05);
}

TEST(Scene, WritesItsObjectsAndReadersSkipThem) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  std::string line;
  Play(scene, lifting, 0.5, [&](double, const recon::SkeletonFrame& frame, Scene&) {
    line = recon::SkeletonJsonLine(frame);
  });
  EXPECT_NE(line.find(R"("objects":[{"name":"table","p":[)"), std::string::npos) << line;
  std::istringstream stream(line);
  recon::SkeletonJsonlReader reader(stream, "played");
  recon::SkeletonFrame read;
  ASSERT_TRUE(reader.Next(read));
  EXPECT_EQ(read.bodies.size(), 2U);
}

}  // namespace
}  // namespace ossa::tracker
