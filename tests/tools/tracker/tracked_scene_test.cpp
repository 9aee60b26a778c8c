// From depth images: people of capsules are tracked, and their hands meet the things of a scene.
#include <gtest/gtest.h>

#include "tests/tools/tracker/played_scenes.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using test::Lifting;
using test::Throwing;

/// Follows people of capsules for so long. `observe` gets each frame after the scene has moved on.
test::Seen Track(const SceneOptions& scene, const test::Choreography& people, int frames,
                 const std::function<void(const BodyFrame&, Scene&)>& observe) {
  TrackerOptions options = PlainOptions();
  options.scene = scene;
  Tracker tracker(options);
  test::Seen seen;
  for (int f = 0; f < frames; ++f) {
    const BodyFrame frame = tracker.Track(Rendered(people(f / 30.0), f, 0.001).frame);
    seen.Update(*tracker.scene());
    observe(frame, *tracker.scene());
  }
  EXPECT_LT(seen.deepest_m, 0.005);
  EXPECT_TRUE(seen.is_finite);
  return seen;
}

TEST(TrackedScene, TwoPeopleLiftABoxTogether) {
  OSSA_NEEDS_MODEL();
  Lifting lifting;
  lifting.second_height_m = 1.5;
  double highest_m = 0.0;
  Track(lifting.Options(), lifting, 135, [&](const BodyFrame& frame, Scene&) {
    for (const SceneObjectState& object : frame.objects) {
      if (object.name == "box") highest_m = std::max(highest_m, object.position_m.y());
    }
  });
  EXPECT_GT(highest_m, -1.0 + test::kTable_m + 0.15 + 0.2);
}

TEST(TrackedScene, OneThrowsABall) {
  OSSA_NEEDS_MODEL();
  const Throwing throwing;
  double ball_m_s = 0.0;
  const test::Seen seen =
      Track(throwing.Options(), throwing, 75, [&](const BodyFrame& frame, Scene& scene) {
        for (const SceneEvent& event : scene.events()) {
          if (event.kind != SceneEvent::Kind::kThrown) continue;
          ball_m_s = frame.objects.back().velocity_m_s.norm();
        }
      });
  EXPECT_EQ(std::count_if(seen.events.begin(), seen.events.end(),
                          [](const auto& e) { return e.kind == SceneEvent::Kind::kThrown; }),
            1);
  // The true hand's fastest is 4.4 m/s; it is tracked to some centimetres from frame to frame.
  EXPECT_GT(ball_m_s, 2.2);
  EXPECT_LT(ball_m_s, 8.8);
}

TEST(TrackedScene, APersonDodgesABall) {
  OSSA_NEEDS_MODEL();
  SceneOptions scene;
  SceneObject ball = test::MakeBall(0.2, 0.2);
  ball.origin = SceneObject::Origin::kPerson;
  ball.body.position_m = {0.0, 1.6, 2.0};
  ball.body.velocity_m_s = {0.0, 0.4 * 0.5 * 9.81, -2.0 / 0.4};  // at the head in 0.4 s
  scene.objects = {ball};
  for (const bool dodges : {false, true}) {
    if (dodges) scene.dodge = DodgeRule{};
    int hits = 0;
    const auto standing = [](double) { return std::vector{test::PersonOf(1.75, 0.0)}; };
    Track(scene, standing, 45, [&](const BodyFrame&, Scene& played) {
      for (const physics::Strike& strike : played.world().Contacts().struck) {
        hits += strike.bone <= recon::Index(recon::Joint::kHead) ? 1 : 0;
      }
    });
    EXPECT_EQ(hits > 0, !dodges);
  }
}

}  // namespace
}  // namespace ossa::tracker
