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

/// What a perfect sensor sees; all images have the camera's size.
struct RenderedImage {
  Image<float> depth_m;     // along the optical axis (z); 0 where nothing was hit
  Image<int32_t> triangle;  // index within its mesh; -1 where nothing was hit
  Image<int16_t> mesh;      // id from AddMesh; -1 where nothing was hit
  Image<float> incidence;   // |cos| of the angle between ray and surface normal
  Image<uint8_t> lit;       // 1 where the projector reaches the surface (RenderOptions::projector)
  /// Share of the infrared light that the surface sends back, [0, 1]; empty: as usual everywhere.
  /// Not filled in by the renderer, which knows no materials.
  Image<float> reflectance{};
};

struct RenderOptions {
  bool projector = false;  // trace the second ray of a structured-light sensor
  /// Camera to projector, metres; Kinect v1: 75 mm. Positive: the projector stands on the side of
  /// the image right, so that shadows fall to the image left of near things, as in real Kinect v1
  /// frames.
  double baseline_m = 0.075;
};

/// A scene of triangle meshes in camera space, and images of it. Not for use by two threads at
/// once: make one for each.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Returns the mesh's id, >= 0; ids of removed meshes are used again. A deforming mesh's tree is
  /// refitted instead of rebuilt when its vertices change. Throws std::invalid_argument when a
  /// triangle names a vertex that is not there.
  int AddMesh(const TriangleMesh& mesh, bool deforming);
  /// As many vertices as the mesh was added with.
  void UpdateVertices(int mesh, std::span<const Eigen::Vector3f> vertices_m);
  void RemoveMesh(int mesh);

  RenderedImage Render(const Camera& camera, const RenderOptions& options = {});

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace ossa::depth
