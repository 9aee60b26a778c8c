#include "depth/image/camera.h"

#include <gtest/gtest.h>

namespace ossa::depth {
namespace {

TEST(Camera, ProjectUndoesBackProject) {
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

TEST(Camera, LeftOfTheImageIsPositiveXAndTopIsPositiveY) {
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

}  // namespace
}  // namespace ossa::depth
