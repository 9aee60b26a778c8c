#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/image.h"

namespace ossa::depth {

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_m;         // camera space
  std::vector<std::array<uint32_t, 3>> triangles;  // indices into vertices_m
};

/// Rendering without sensor errors; all images have the camera's size.
struct RenderedImage {
  Image<float> depth_m;     // along the optical axis (z); 0 where nothing was hit
  Image<int32_t> triangle;  // index within its mesh; -1 where nothing was hit
  Image<int16_t> mesh;      // id from AddMesh; -1 where nothing was hit
  Image<float> incidence;   // |cos| of the angle between ray and surface normal
  Image<uint8_t> lit;       // 1 where the projector reaches the surface (RenderOptions::projector)
  /// Infrared reflectance of the surface, [0, 1]; empty: the default everywhere. Not filled by the
  /// renderer, which has no materials.
  Image<float> reflectance{};
};

struct RenderOptions {
  bool projector = false;  // trace the second ray of a structured-light sensor
  /// Baseline from camera to projector, metres; Kinect v1: 75 mm. Positive: the projector is on the
  /// image right, so that near objects cast shadows to the image left, as in real Kinect v1 frames.
  double baseline_m = 0.075;
};

/// Renders a scene of triangle meshes in camera space. Not thread-safe: use one per thread.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Returns the mesh's id, >= 0; ids of removed meshes are reused. A deforming mesh's BVH is
  /// refitted instead of rebuilt when its vertices change. Throws std::invalid_argument if a
  /// triangle has an invalid vertex index.
  int AddMesh(const TriangleMesh& mesh, bool deforming);
  /// Replaces the vertices; their number must not change.
  void UpdateVertices(int mesh, std::span<const Eigen::Vector3f> vertices_m);
  void RemoveMesh(int mesh);

  RenderedImage Render(const Camera& camera, const RenderOptions& options = {});

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace ossa::depth
