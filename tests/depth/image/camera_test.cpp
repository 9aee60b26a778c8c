#include "depth/image/camera.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/refused.h"

namespace ossa::depth {
namespace {

TEST(Camera, ProjectionAndBackProjectionAreInverse) {
  const Camera camera = KinectV1Camera(640, 480);
  for (double u : {0.0, 17.25, 320.0, 639.0}) {
    for (double v : {0.0, 240.0, 479.5}) {
      const Eigen::Vector2d back = Project(camera, BackProject(camera, u, v, 2345.0));
      // Two multiplications and two divisions: a few units in the last place of 640.
      EXPECT_NEAR(back.x(), u, 1e-12 * 640);
      EXPECT_NEAR(back.y(), v, 1e-12 * 640);
    }
  }
}

TEST(Camera, ImageLeftIsPositiveXAndTopIsPositiveY) {
  const Camera camera = KinectV1Camera(640, 480);
  const Eigen::Vector3d point_m = BackProject(camera, 0.0, 0.0, 1000.0);
  EXPECT_GT(point_m.x(), 0.0);
  EXPECT_GT(point_m.y(), 0.0);
  EXPECT_DOUBLE_EQ(point_m.z(), 1.0);
}

TEST(Camera, KinectFocalLengthScalesWithTheWidth) {
  EXPECT_DOUBLE_EQ(KinectV1Camera(320, 240).fx, 287.5);
  EXPECT_EQ(Resized(KinectV1Camera(640, 480), 320, 240), KinectV1Camera(320, 240));
}

TEST(Camera, CroppingShiftsProjections) {
  const Camera whole = KinectV1Camera(640, 480), part = Cropped(whole, 320, 100, 320, 240);
  EXPECT_EQ(BackProject(part, 10, 20, 1500), BackProject(whole, 330, 120, 1500));
  EXPECT_EQ(part.width, 320);
  EXPECT_EQ(part.height, 240);
}

struct Wrong {
  const char* field;
  Camera camera;
};

TEST(Camera, InvalidFieldIsRefusedByName) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(IsSane(Camera{}));
  EXPECT_TRUE(IsSane({1, 8192, 0.1, 1e6, -1e6, 1e6}));
  EXPECT_NO_THROW(CheckCamera(Camera{}, "x"));
  for (const auto& [field, camera] : {Wrong{"width", {0, 480, 575, 575, 320, 240}},
                                      {"height", {640, 8193, 575, 575, 320, 240}},
                                      {"fx", {640, 480, 0, 575, 320, 240}},
                                      {"fx", {640, 480, kNan, 575, 320, 240}},
                                      {"fx", {640, 480, 1e-300, 575, 320, 240}},
                                      {"fy", {640, 480, 575, -575, 320, 240}},
                                      {"fy", {640, 480, 575, kInfinity, 320, 240}},
                                      {"cx", {640, 480, 575, 575, -kInfinity, 240}},
                                      {"cy", {640, 480, 575, 575, 320, kNan}}}) {
    EXPECT_FALSE(IsSane(camera)) << field;
    test::ExpectRefused([&, &camera = camera] { CheckCamera(camera, "x"); },
                        std::string("x: \"") + field + '"');
  }
}

}  // namespace
}  // namespace ossa::depth
