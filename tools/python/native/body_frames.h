#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "recon/fit/body_mesh.h"
#include "tools/python/native/arrays.h"
#include "tools/python/native/native.h"
#include "tools/tracker/tracker.h"

namespace ossa::python {

using MeshPointer = std::shared_ptr<const recon::BodyMesh>;

/// The skin of a body, posed on request. It is an object because creating a function for each body
/// would take longer than the rest of the conversion.
struct Skin {
  MeshPointer mesh;
  recon::SurfacePose pose;
};

/// Vertex positions, metres, camera space: float64 [v, 3].
py::array ComputeVertices(const Skin& skin);
/// Vertex indices of triangles, int32 [f, 3].
py::array ToArray(const std::vector<recon::MeshTriangle>& triangles);

/// The fields of ossa.Frame (ossa/_frames.py) with those of its bodies and objects. mesh: null
/// without a surface fit.
py::dict ToDict(tracker::BodyFrame frame, bool with_proposals, const MeshPointer& mesh);

}  // namespace ossa::python
