#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "depth/render/renderer.h"

namespace ossa::depth {

// Simple solids and furniture as meshes, metres, centred on the origin unless stated otherwise, y
// up.

TriangleMesh MakeBox(const Eigen::Vector3f& size_m);
TriangleMesh MakeBall(float radius_m, int segments = 16);
/// Axis along y; `length_m` is the distance between the centres of the two hemispheres.
TriangleMesh MakeCapsule(float radius_m, float length_m, int segments = 12);
/// A board with its upper face at y = height_m on four legs that stand on y = 0.
TriangleMesh MakeTable(const Eigen::Vector3f& size_m);
/// A seat on four legs with a back rest on its -z side; stands on y = 0, faces +z.
TriangleMesh MakeChair(float seat_height_m, float width_m, float back_height_m);
/// A sofa: seat, back on its -z side and two arms; stands on y = 0, faces +z.
TriangleMesh MakeSofa(float width_m, float depth_m, float seat_height_m);
/// A room seen from inside: floor at y = 0, walls and ceiling; centred on x = z = 0.
TriangleMesh MakeRoom(const Eigen::Vector3f& size_m);

/// Appends `more` to `mesh`.
void Append(TriangleMesh& mesh, const TriangleMesh& more);
/// The mesh moved by a rigid (or scaling) transform.
TriangleMesh Moved(TriangleMesh mesh, const Eigen::Affine3f& to_from_mesh);

}  // namespace ossa::depth
