// Sensors that leave out single pixels all over the image.
#include <algorithm>

#include "depth/base/random.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

depth::DepthFrame WithoutEveryFifthPixel(depth::DepthFrame frame) {
  Random random(11);
  for (uint16_t& z_mm : frame.depth_mm) {
    if (random.Uniform(0.0, 1.0) < 0.2) z_mm = 0;
  }
  return frame;
}

TrackerOptions KeepingParts() {
  TrackerOptions options = PlainOptions();
  options.keep_parts = true;
  options.keep_probabilities = true;
  return options;
}

TEST(ScatteredHoles, LeaveJointsWhereTheyAre) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.0, 1.8)});
  const BodyFrame whole = Tracker(PlainOptions()).Track(render.frame);
  const BodyFrame holed = Tracker(PlainOptions()).Track(WithoutEveryFifthPixel(render.frame));
  ASSERT_EQ(whole.bodies.size(), 1U);
  ASSERT_EQ(holed.bodies.size(), 1U);
  recon::JointArray<double> apart_m;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    apart_m[j] =
        (holed.bodies[0].joints[j].position_m - whole.bodies[0].joints[j].position_m).norm();
  }
  std::sort(apart_m.begin(), apart_m.end());
  EXPECT_LT(apart_m[recon::kJointCount / 2], 0.015);  // 0.044 without it
}

TEST(ScatteredHoles, BelongToNoPerson) {
  OSSA_NEEDS_MODEL();
  const auto frame = WithoutEveryFifthPixel(Rendered({PersonAt(0.0, 1.8)}).frame);
  const BodyFrame bodies = Tracker(KeepingParts()).Track(frame);
  ASSERT_EQ(bodies.bodies.size(), 1U);
  const auto classes = static_cast<size_t>(bodies.probabilities.classes);
  int of_user = 0;
  for (size_t p = 0; p < frame.depth_mm.size(); ++p) {
    of_user += bodies.users.data[p] != 0 ? 1 : 0;
    ASSERT_EQ(bodies.users.data[p] != 0, bodies.parts.data[p] != 0) << "pixel " << p;
    if (frame.depth_mm[p] != 0) continue;
    ASSERT_EQ(bodies.users.data[p], 0) << "pixel " << p;
    ASSERT_EQ(bodies.probabilities.data[p * classes], 0.0F) << "pixel " << p;
  }
  EXPECT_GT(of_user, 1000);
}

}  // namespace
}  // namespace ossa::tracker
