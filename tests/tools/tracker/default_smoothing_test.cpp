// Which filter joints go through at the end when nobody says.
#include "ossa/ossa_c.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

constexpr int kFrames = 5;

/// The head after a few steps to the side.
Eigen::Vector3d HeadAfterAWalk(const TrackerOptions& options) {
  Tracker tracker(options);
  BodyFrame last;
  for (int f = 0; f < kFrames; ++f)
    last = tracker.Track(Rendered({PersonAt(0.03 * f, 2.5)}, f).frame);
  EXPECT_EQ(last.bodies.size(), 1U);
  return last.bodies.empty() ? Eigen::Vector3d::Zero()
                             : last.bodies[0].joints[recon::Joint::kHead].position_m;
}

Eigen::Vector3d HeadBy(const std::string& method, const char* smoothing = nullptr) {
  TrackerOptions options;
  options.method = method;
  if (smoothing != nullptr) options.smoothing = SmoothingPreset(smoothing);
  return HeadAfterAWalk(options);
}

TEST(DefaultSmoothing, FollowsTheMethodInCpp) {
  OSSA_NEEDS_MODEL();
  EXPECT_EQ(HeadBy("none"), HeadBy("none", "default"));
  EXPECT_NE(HeadBy("none"), HeadBy("none", "none"));
}

TEST(DefaultSmoothing, IsTheSameInC) {
  OSSA_NEEDS_MODEL();
  ossa_options options{};
  options.struct_size = sizeof options;
  options.method = "none";
  ossa_tracker* tracker = ossa_tracker_create(&options);
  ossa_body body{};
  body.struct_size = sizeof body;
  for (int f = 0; f < kFrames; ++f) {
    const auto render = Rendered({PersonAt(0.03 * f, 2.5)}, f);
    const depth::Camera& c = render.frame.camera;
    ossa_depth_image image{
        sizeof image,       c.width, c.height, c.fx, c.fy, c.cx, c.cy, render.frame.depth_mm.data(),
        render.frame.time_s};
    ossa_frame frame{};
    frame.struct_size = sizeof frame;
    ASSERT_EQ(ossa_tracker_track(tracker, &image, &frame), OSSA_OK) << ossa_last_error();
    ASSERT_EQ(ossa_tracker_body(tracker, 0, &body), OSSA_OK) << ossa_last_error();
  }
  ossa_tracker_destroy(tracker);
  const Eigen::Vector3f head = HeadBy("none").cast<float>();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(body.joints[OSSA_HEAD].position_m[i], head[i]);
}

class MethodThatFilters : public testing::TestWithParam<const char*> {};

TEST_P(MethodThatFilters, GetsNoSecondFilter) {
  OSSA_NEEDS_MODEL();
  EXPECT_EQ(HeadBy(GetParam()), HeadBy(GetParam(), "none"));
  EXPECT_NE(HeadBy(GetParam()), HeadBy(GetParam(), "default"));
}

INSTANTIATE_TEST_SUITE_P(DefaultSmoothing, MethodThatFilters,
                         testing::Values("holt", "one-euro", "kalman", "best"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace ossa::tracker
