#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "recon/fit/body_surface.h"
#include "recon/fit/posed_surface.h"
#include "recon/posture.h"

namespace ossa::recon {

/// The mesh of the shipped body surface, among the shipped files.
inline constexpr const char* kShippedMesh = "body.ossamesh";

/// A vertex of the skin, bound to up to four bones of a humanoid (recon/motion/humanoid.h).
struct MeshVertex {
  std::array<uint8_t, 4> bone{};
  std::array<float, 4> weight{};  // their sum is 1
  ShapedPlace place;              // relative to the pelvis joint, axes of the rest pose
};

/// Vertex indices of a triangle, counter-clockwise from outside.
using MeshTriangle = std::array<uint32_t, 3>;

/// The skin of a body surface as a triangle mesh, for display of the fitted body. It is learned
/// together with its surface (`ossa surface --mesh`) and has the same shape parameters.
struct BodyMesh {
  BodySurface surface;
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;

  /// .ossamesh: reads refuse damaged and hostile files by name and byte, and meshes of another
  /// surface than `surface`.
  static constexpr uint32_t kVersion = 1;
  static constexpr size_t kMostVertices = 16384;  // by hand: more would gain nothing
  static BodyMesh Load(const std::filesystem::path& path, const BodySurface& surface);
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// The segment that drives a bone of the humanoid.
size_t SegmentOfHumanBone(size_t bone);

/// Linear-blend skinning: the posed vertices, camera space, metres.
std::vector<Eigen::Vector3d> PoseMesh(const BodyMesh& mesh, const SurfacePose& pose);

}  // namespace ossa::recon
