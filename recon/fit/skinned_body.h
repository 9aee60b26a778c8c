#pragma once
#include <Eigen/Core>
#include <vector>

#include "recon/fit/body_mesh.h"

namespace ossa::recon {

/// An avatar in its bind pose: skin around joints in a T-pose, feet on y = 0, facing +z, left = +x,
/// metres.
struct SkinnedBody {
  Posture joints_m;
  std::vector<Eigen::Vector3d> vertices_m;  // of BodyMesh::vertices
  std::vector<Eigen::Vector3d> normals;     // unit, outwards
};

/// The body of a shape in a T-pose, arms sideways and legs straight down; trunk, shoulders and feet
/// keep their standing pose. It is stretched along each bone to the person's own lengths, and in
/// girth by the overall ratio of bone lengths.
SkinnedBody BuildTPosedBody(const BodyMesh& mesh, const ShapeVector& shape,
                            const BoneLengths& lengths_m);

}  // namespace ossa::recon
