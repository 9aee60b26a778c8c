#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "recon/body/rig.h"

namespace ossa::recon {

/// A mean of vertices: where the rig's files put a joint.
using VertexMean = std::vector<uint32_t>;

/// The MPFB files as they are: decimetres, y up, facing +z, vertices numbered as in base.obj.
struct BodyFiles {
  struct Target {
    std::string name;  // e.g. "african-male-young"
    std::vector<uint32_t> index;
    std::vector<Eigen::Vector3f> delta_dm;
  };
  std::string mesh_file;  // for messages
  std::vector<Eigen::Vector3f> vertex_dm;
  std::map<std::string, std::vector<std::vector<uint32_t>>> faces;  // by group, polygons
  std::vector<Target> targets;                                      // by name
  std::array<VertexMean, kRigBoneCount> bone_head;
  std::array<VertexMean, kRigBoneCount> bone_tail;
  std::vector<std::vector<std::pair<uint8_t, float>>> weights;  // per vertex: bone, weight

  /// The vertices of a group, ascending and unique; of a joint-* cube its 8 corners.
  VertexMean Vertices(const std::string& group) const;
};

/// Throws InputError naming file, line or field.
BodyFiles ReadBodyFiles(const std::filesystem::path& folder);

/// Whether any of the files in the folder was changed after the file `than`.
bool AreFilesNewer(const std::filesystem::path& folder, const std::filesystem::path& than);

}  // namespace ossa::recon
