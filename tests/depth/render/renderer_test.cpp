#include "depth/render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace ossa::depth {
namespace {

/// A rectangle facing the camera, `id`s counted by triangle.
TriangleMesh Board(float left_m, float right_m, float bottom_m, float top_m, float z_m) {
  return {{{left_m, bottom_m, z_m},
           {right_m, bottom_m, z_m},
           {right_m, top_m, z_m},
           {left_m, top_m, z_m}},
          {{0, 1, 2}, {0, 2, 3}}};
}

const Camera kCamera{64, 48, 50.0, 50.0, 32.0, 24.0};

TEST(Renderer, ProjectsABoardByThePinholeModel) {
  Renderer renderer;
  const int board = renderer.AddMesh(Board(0.1F, 0.3F, -0.2F, 0.2F, 2.0F), false);
  const RenderedImage image = renderer.Render(kCamera);
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Eigen::Vector3d point_m = BackProject(kCamera, u, v, 2000.0);
      const double margin_m =
          std::min({point_m.x() - 0.1, 0.3 - point_m.x(), 0.2 - std::abs(point_m.y())});
      if (std::abs(margin_m) < 1e-4) continue;  // on the border either answer is right
      EXPECT_EQ(image.mesh.at(u, v), margin_m > 0 ? board : -1) << u << "," << v;
      // Depth is z along the axis, not distance along the ray; float rounding of 2 m.
      EXPECT_NEAR(image.depth_m.at(u, v), margin_m > 0 ? 2.0F : 0.0F, 1e-5F);
    }
  }
}

TEST(Renderer, IncidenceIsTheCosineToTheSurfaceNormal) {
  Renderer renderer;
  renderer.AddMesh(Board(-2, 2, -2, 2, 2.0F), false);
  const RenderedImage image = renderer.Render(kCamera);
  const Eigen::Vector3d ray = BackProject(kCamera, 10, 5, 1000.0).normalized();
  EXPECT_NEAR(image.incidence.at(10, 5), ray.z(), 1e-5);
}

TEST(Renderer, FollowsADeformingMesh) {
  Renderer renderer;
  const int id = renderer.AddMesh(Board(-2, 2, -2, 2, 2.0F), true);
  renderer.Render(kCamera);
  for (const float z_m : {2.5F, 1.0F}) {
    renderer.UpdateVertices(id, Board(-2, 2, -2, 2, z_m).vertices_m);
    EXPECT_NEAR(renderer.Render(kCamera).depth_m.at(32, 24), z_m, 1e-5F);
  }
  renderer.RemoveMesh(id);
  EXPECT_EQ(renderer.Render(kCamera).depth_m.at(32, 24), 0.0F);
}

// A wall of squares whose corners lie on pixel rays: most rays hit edges, each of two triangles.
TriangleMesh WallOfSquares() {
  constexpr uint32_t kSide = 24;
  constexpr float kSquare_m = 2.0F / 50.0F;  // a pixel of kCamera at 2 m
  TriangleMesh mesh;
  for (uint32_t row = 0; row <= kSide; ++row) {
    for (uint32_t column = 0; column <= kSide; ++column) {
      mesh.vertices_m.emplace_back(kSquare_m * (static_cast<float>(column) - kSide / 2),
                                   kSquare_m * (static_cast<float>(row) - kSide / 2), 2.0F);
      if (row == kSide || column == kSide) continue;
      const uint32_t corner = row * (kSide + 1) + column;
      mesh.triangles.push_back({corner, corner + 1, corner + kSide + 1});
      mesh.triangles.push_back({corner + 1, corner + kSide + 2, corner + kSide + 1});
    }
  }
  return mesh;
}

// Threads share a data set's frames: an image must not depend on earlier ones.
TEST(Renderer, TiesDoNotDependOnEarlierRenderings) {
  const TriangleMesh wall = WallOfSquares();
  std::vector<Eigen::Vector3f> rolled = wall.vertices_m;
  for (Eigen::Vector3f& p : rolled)
    p = {std::sin(7 * p.x()), p.y() * p.x(), 2 + std::cos(9 * p.x())};
  Renderer fresh;
  fresh.AddMesh(wall, true);
  Renderer used;
  const int id = used.AddMesh(wall, true);
  used.UpdateVertices(id, rolled);
  used.Render(kCamera);
  used.UpdateVertices(id, wall.vertices_m);
  EXPECT_EQ(used.Render(kCamera).triangle.data, fresh.Render(kCamera).triangle.data);
}

TEST(Renderer, ShadowsAreAtTheLeftWithTheWidthOfTheBaseline) {
  Renderer renderer;
  const Camera camera = KinectV1Camera(640, 480);
  const int near = renderer.AddMesh(Board(-0.1F, 0.1F, -0.5F, 0.5F, 1.0F), false);
  renderer.AddMesh(Board(-5, 5, -5, 5, 2.0F), false);
  const RenderedImage image = renderer.Render(camera, {.projector = true, .baseline_m = 0.075});
  // Seen from x = -b the near edge x = 0.1 m at 1 m covers the wall at 2 m up to
  // -b + 2 (0.1 + b) = 0.275 m; the camera sees the wall from 0.2 m on: 75 mm in shadow.
  int shadow_px = 0;
  for (int u = 0; u < 640; ++u) {
    if (image.mesh.at(u, 240) == near || image.lit.at(u, 240) != 0) continue;
    EXPECT_LT(u, 320) << "shadow on the wrong side";
    ++shadow_px;
  }
  EXPECT_NEAR(shadow_px, 0.075 / 2.0 * camera.fx, 2.0);  // an edge pixel either side
}

TEST(Renderer, RefusesInvalidVertexIndices) {
  TriangleMesh mesh = Board(0, 1, 0, 1, 1);
  mesh.triangles.push_back({0, 1, 4});
  EXPECT_THROW(Renderer().AddMesh(mesh, false), std::invalid_argument);
}

}  // namespace
}  // namespace ossa::depth
