#include "depth/render/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ossa::depth {
namespace {

/// Volume inside a closed mesh by the divergence theorem; negative when its faces look inwards.
double Volume_m3(const TriangleMesh& mesh) {
  double volume_m3 = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume_m3 += mesh.vertices_m[a].dot(mesh.vertices_m[b].cross(mesh.vertices_m[c])) / 6.0;
  }
  return volume_m3;
}

TEST(Shapes, AreClosedWithTheirVolume) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(Volume_m3(MakeBox({0.2F, 0.3F, 0.4F})), 0.024, 1e-6);
  // A polyhedron inside the ball: at 48 segments its volume is short by well under 1 %.
  EXPECT_NEAR(Volume_m3(MakeBall(0.5F, 48)), 4.0 / 3.0 * kPi * 0.125, 0.01);
  EXPECT_NEAR(Volume_m3(MakeCapsule(0.1F, 0.5F, 48)), kPi * 0.01 * (0.5 + 4.0 / 3.0 * 0.1), 3e-4);
  // Legs touch the top without overlapping it.
  EXPECT_NEAR(Volume_m3(MakeTable({1.0F, 0.7F, 0.6F})), 0.04 * 0.6 + 4 * 0.0025 * 0.66, 1e-5);
}

TEST(Shapes, FurnitureStandsOnTheFloor) {
  for (const TriangleMesh& mesh : {MakeTable({1, 0.7F, 0.6F}), MakeChair(0.45F, 0.45F, 0.5F),
                                   MakeSofa(1.6F, 0.7F, 0.42F), MakeRoom({4, 2.5F, 5})}) {
    float lowest_m = 1e9F;
    for (const Eigen::Vector3f& vertex_m : mesh.vertices_m)
      lowest_m = std::min(lowest_m, vertex_m.y());
    EXPECT_NEAR(lowest_m, 0.0F, 1e-6F);
  }
}

TEST(Shapes, DepthOfABallEqualsTheClosedForm) {
  Renderer renderer;
  const Camera camera = KinectV1Camera(320, 240);
  renderer.AddMesh(
      Moved(MakeBall(0.3F, 96), Eigen::Affine3f(Eigen::Translation3f(0.0F, 0.0F, 2.0F))), false);
  const RenderedImage image = renderer.Render(camera);
  for (const auto& [u, v] : {std::pair{160, 120}, {150, 110}, {175, 130}}) {
    const Eigen::Vector3d ray = BackProject(camera, u, v, 1000.0);
    // |t ray - c|² = r², the nearer root; ray.z = 1 so t is the depth.
    const double a = ray.squaredNorm();
    const double b = 2.0 * ray.z();
    const double depth_m = (b - std::sqrt(b * b - a * (4.0 - 0.09))) / a;
    // 96 segments: the sagitta of a facet is r (1 - cos(pi/96)) = 0.16 mm.
    EXPECT_NEAR(image.depth_m.at(u, v), depth_m, 2e-4);
  }
}

}  // namespace
}  // namespace ossa::depth
