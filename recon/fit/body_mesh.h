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

/// One corner of the skin, carried by up to four bones of a humanoid (recon/motion/humanoid.h).
struct MeshVertex {
  std::array<uint8_t, 4> bone{};
  std::array<float, 4> weight{};  // their sum is 1
  ShapedPlace place;              // from the pelvis' joint, axes of the rest pose
};

/// Corner numbers of a triangle, counter-clockwise from outside.
using MeshTriangle = std::array<uint32_t, 3>;

/// The skin of a body surface as triangles: what the fitted body looks like. Learned together with
/// its surface (`ossa surface --mesh`), so that one shape moves both.
struct BodyMesh {
  BodySurface surface;
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;

  /// .ossamesh: reads refuse damaged and hostile files by name and byte, and the mesh of another
  /// surface than `surface`.
  static constexpr uint32_t kVersion = 1;
  static constexpr size_t kMostVertices = 16384;  // by hand: more would gain nothing
  static BodyMesh Load(const std::filesystem::path& path, const BodySurface& surface);
  void Save(const std::filesystem::path& path) const;
  /// True when the file says that it is one; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// The segment that moves as each bone of a humanoid does.
size_t SegmentOfHumanBone(size_t bone);

/// The vertices in a pose, linear-blend skinning: camera space, metres, one per vertex.
std::vector<Eigen::Vector3d> PoseMesh(const BodyMesh& mesh, const SurfacePose& pose);

}  // namespace ossa::recon
