#pragma once
#include <Eigen/Core>
#include <vector>

#include "recon/fit/body_mesh.h"

namespace ossa::recon {

/// A person as avatars are kept: skin around joints in a T-pose, feet on y = 0, facing +z, left =
/// +x, metres.
struct SkinnedBody {
  Posture joints_m;
  std::vector<Eigen::Vector3d> vertices_m;  // of BodyMesh::vertices
  std::vector<Eigen::Vector3d> normals;     // unit, outwards
};

/// The body of a shape in a T-pose, arms to the sides and legs straight down; trunk, shoulders and
/// feet as it stands. Stretched along each bone to the person's own lengths, and in girth as its
/// bones are longer or shorter on the whole.
SkinnedBody BuildTPosedBody(const BodyMesh& mesh, const ShapeVector& shape,
                            const BoneLengths& lengths_m);

}  // namespace ossa::recon
