#include "depth/render/shapes.h"

#include <numbers>

namespace ossa::depth {
namespace {

// Constants: sizes of furniture, chosen by hand.

TriangleMesh BoxAt(const Eigen::Vector3f& size_m, const Eigen::Vector3f& centre_m) {
  return Moved(MakeBox(size_m), Eigen::Affine3f(Eigen::Translation3f(centre_m)));
}

/// Four square legs below the corners of a width × depth seat or table top.
void AppendLegs(TriangleMesh& mesh, float width_m, float depth_m, float height_m) {
  constexpr float kLeg_m = 0.05F;
  for (const float side_x : {-1.0F, 1.0F}) {
    for (const float side_z : {-1.0F, 1.0F}) {
      Append(mesh, BoxAt({kLeg_m, height_m, kLeg_m}, {side_x * (width_m - kLeg_m) / 2, height_m / 2,
                                                      side_z * (depth_m - kLeg_m) / 2}));
    }
  }
}

}  // namespace

TriangleMesh MakeBox(const Eigen::Vector3f& size_m) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 8; ++i) {
    const Eigen::Vector3f corner((i & 1U) != 0 ? 0.5F : -0.5F, (i & 2U) != 0 ? 0.5F : -0.5F,
                                 (i & 4U) != 0 ? 0.5F : -0.5F);
    mesh.vertices_m.push_back(corner.cwiseProduct(size_m));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh MakeBall(float radius_m, int segments) {
  return MakeCapsule(radius_m, 0.0F, segments);
}

TriangleMesh MakeCapsule(float radius_m, float length_m, int segments) {
  TriangleMesh mesh;
  const int rings = segments;  // half of them for each hemisphere
  for (int ring = 0; ring <= rings; ++ring) {
    // The equator ring is duplicated if there is a cylinder between the hemispheres.
    for (const float shift_m : {-0.5F, 0.5F}) {
      const bool lower = 2 * ring <= rings;
      const bool upper = 2 * ring >= rings;
      if ((shift_m < 0 && !lower) || (shift_m > 0 && !upper)) continue;
      const float polar =
          std::numbers::pi_v<float> * static_cast<float>(ring) / static_cast<float>(rings);
      for (int i = 0; i < segments; ++i) {
        const float around =
            2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(segments);
        mesh.vertices_m.emplace_back(radius_m * std::sin(polar) * std::cos(around),
                                     -radius_m * std::cos(polar) + shift_m * length_m,
                                     radius_m * std::sin(polar) * std::sin(around));
      }
    }
  }
  const auto n = static_cast<uint32_t>(segments);
  const auto ring_count = static_cast<uint32_t>(mesh.vertices_m.size()) / n;
  for (uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t here = ring * n + i;
      const uint32_t next = ring * n + (i + 1) % n;
      mesh.triangles.push_back({here, here + n, next});
      mesh.triangles.push_back({next, here + n, next + n});
    }
  }
  return mesh;
}

TriangleMesh MakeTable(const Eigen::Vector3f& size_m) {
  constexpr float kTop_m = 0.04F;
  TriangleMesh mesh =
      BoxAt({size_m.x(), kTop_m, size_m.z()}, {0.0F, size_m.y() - kTop_m / 2, 0.0F});
  AppendLegs(mesh, size_m.x(), size_m.z(), size_m.y() - kTop_m);
  return mesh;
}

TriangleMesh MakeChair(float seat_height_m, float width_m, float back_height_m) {
  constexpr float kBack_m = 0.05F;
  TriangleMesh mesh = MakeTable({width_m, seat_height_m, width_m});
  Append(mesh, BoxAt({width_m, back_height_m, kBack_m},
                     {0.0F, seat_height_m + back_height_m / 2, -(width_m - kBack_m) / 2}));
  return mesh;
}

TriangleMesh MakeSofa(float width_m, float depth_m, float seat_height_m) {
  constexpr float kBack_m = 0.2F;
  constexpr float kArm_m = 0.18F;
  const float back_height_m = seat_height_m + 0.4F;
  const float arm_height_m = seat_height_m + 0.2F;
  TriangleMesh mesh = BoxAt({width_m, seat_height_m, depth_m}, {0.0F, seat_height_m / 2, 0.0F});
  Append(mesh, BoxAt({width_m, back_height_m, kBack_m},
                     {0.0F, back_height_m / 2, -(depth_m + kBack_m) / 2}));
  for (const float side : {-1.0F, 1.0F}) {
    Append(mesh, BoxAt({kArm_m, arm_height_m, depth_m},
                       {side * (width_m + kArm_m) / 2, arm_height_m / 2, 0.0F}));
  }
  return mesh;
}

TriangleMesh MakeRoom(const Eigen::Vector3f& size_m) {
  // Faces are two-sided, so a box seen from inside is a room.
  return BoxAt(size_m, {0.0F, size_m.y() / 2, 0.0F});
}

void Append(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto first = static_cast<uint32_t>(mesh.vertices_m.size());
  mesh.vertices_m.insert(mesh.vertices_m.end(), more.vertices_m.begin(), more.vertices_m.end());
  for (const auto& [a, b, c] : more.triangles) {
    mesh.triangles.push_back({a + first, b + first, c + first});
  }
}

TriangleMesh Moved(TriangleMesh mesh, const Eigen::Affine3f& to_from_mesh) {
  for (Eigen::Vector3f& vertex_m : mesh.vertices_m) vertex_m = to_from_mesh * vertex_m;
  return mesh;
}

}  // namespace ossa::depth
