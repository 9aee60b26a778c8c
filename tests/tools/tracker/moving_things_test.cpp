// Moving objects that enter a known room and are no people: animals, furniture that is pushed.
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using tests::Box;
using tests::Capsule;

constexpr double kFloor_m = -1.0;  // of tests::EmptyRoom

// Objects at x = 0, z = 0 on the floor at y = 0.
struct Thing {
  const char* name;
  std::vector<Box> boxes;
  std::vector<Capsule> capsules;
};

void PrintTo(const Thing& thing, std::ostream* out) { *out << thing.name; }

// Shoulders `height_m` high, seen from the side.
Thing Dog(const char* name, double height_m) {
  const double s = height_m / 0.6;
  Thing dog{name, {}, {}};
  const auto add = [&](const Vector3d& a, const Vector3d& b, double radius_m) {
    dog.capsules.push_back({s * a, s * b, s * radius_m, 0, 0});
  };
  add({-0.3, 0.5, 0}, {0.3, 0.48, 0}, 0.12);     // trunk
  add({0.36, 0.55, 0}, {0.46, 0.68, 0}, 0.07);   // neck
  add({0.46, 0.70, 0}, {0.62, 0.66, 0}, 0.07);   // head
  add({-0.4, 0.52, 0}, {-0.6, 0.65, 0}, 0.025);  // tail
  for (const double x : {-0.3, 0.3}) {
    for (const double z : {-0.07, 0.07}) add({x, 0.42, z}, {x, 0.04, z}, 0.045);
  }
  return dog;
}

Thing OfficeChair() {
  return {"OfficeChair",
          {{{-0.25, 0.44, -0.25}, {0.25, 0.52, 0.25}},
           {{-0.22, 0.6, 0.2}, {0.22, 1.05, 0.26}},
           {{-0.03, 0.08, -0.03}, {0.03, 0.44, 0.03}},
           {{-0.04, 0.5, 0.22}, {0.04, 0.62, 0.25}},
           {{-0.32, 0.03, -0.04}, {0.32, 0.1, 0.04}},
           {{-0.04, 0.03, -0.32}, {0.04, 0.1, 0.32}}},
          {}};
}

Thing Carton() { return {"Carton", {{{-0.3, 0, -0.25}, {0.3, 0.6, 0.25}}}, {}}; }
Thing Shelf() { return {"Shelf", {{{-0.2, 0, -0.2}, {0.2, 1.3, 0.2}}}, {}}; }
Thing GymBall() { return {"GymBall", {}, {{{0, 0.33, 0}, {0, 0.33, 0}, 0.33, 0, 0}}}; }

tests::CapsuleRender Shown(const Thing& thing, const Vector3d& place_m, int frame) {
  tests::CapsuleScene scene;
  scene.planes = tests::EmptyRoom();
  for (Box box : thing.boxes) {
    box.low_m += place_m, box.high_m += place_m;
    scene.boxes.push_back(box);
  }
  for (Capsule capsule : thing.capsules) {
    capsule.a_m += place_m, capsule.b_m += place_m;
    scene.capsules.push_back(capsule);
  }
  scene.noise_m = 0.0015;
  scene.seed = static_cast<uint64_t>(frame) + 1;
  auto render = tests::Render(scene, depth::KinectV1Camera(320, 240));
  render.frame.index = frame;
  render.frame.time_s = frame / 30.0;
  return render;
}

class MovingObject : public testing::TestWithParam<Thing> {};

TEST_P(MovingObject, IsNotAPerson) {
  OSSA_NEEDS_MODEL();
  constexpr int kEmpty = 10, kFrames = 90;
  for (const double z_m : {2.2, 3.2}) {
    Tracker tracker(PlainOptions());
    const double from_m = 0.75 * z_m, step_m = 2 * from_m / (kFrames - kEmpty);
    int bodies = 0;
    for (int f = 0; f < kFrames; ++f) {
      const bool there = f >= kEmpty;
      const Vector3d place_m(-from_m + step_m * (f - kEmpty), kFloor_m, z_m);
      bodies += static_cast<int>(
          tracker.Track(Shown(there ? GetParam() : Thing{}, place_m, f).frame).bodies.size());
    }
    EXPECT_EQ(bodies, 0) << z_m << " m away";
  }
}

INSTANTIATE_TEST_SUITE_P(Things, MovingObject,
                         testing::Values(Dog("Dog", 0.6), Dog("Spaniel", 0.4), OfficeChair(),
                                         Carton(), Shelf(), GymBall()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace ossa::tracker
