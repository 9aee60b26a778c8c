// Projection between pixels and camera space, for ossa_c.h.
#include <algorithm>
#include <string>

#include "depth/image/camera.h"
#include "depth/image/turn.h"
#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/c_tracker_internal.h"

namespace {

using ossa::tracker::CameraFrom;
using ossa::tracker::CopyVector;
using ossa::tracker::Guarded;
using ossa::tracker::ReadStruct;
using ossa::tracker::RequireNotNull;

void RequireBefore(float depth, const char* call, const char* what) {
  if (depth > 0.0F) return;  // false of NaN, too
  throw std::invalid_argument(std::string(call) + ": expected " + what + " above 0, found " +
                              std::to_string(depth));
}

}  // namespace

ossa::depth::Camera ossa::tracker::CameraFrom(const ossa_depth_image& image) {
  const depth::Camera camera = {image.width, image.height, image.fx, image.fy, image.cx, image.cy};
  depth::CheckCamera(camera, "ossa_depth_image");
  return camera;
}

ossa_status ossa_unmirror(ossa_depth_image* image, uint16_t* depth_mm) {
  return Guarded([&] {
    RequireNotNull(image, "ossa_unmirror", "an image");
    RequireNotNull(depth_mm, "ossa_unmirror", "a place for its depths");
    const ossa_depth_image given = ReadStruct(*image);
    RequireNotNull(given.depth_mm, "ossa_unmirror", "depths");
    ossa::depth::DepthFrame mirrored;
    mirrored.camera = CameraFrom(given);
    mirrored.borrowed = {given.depth_mm, given.width, given.height, given.width};
    const ossa::depth::DepthFrame frame = ossa::depth::Unmirrored(mirrored);
    std::copy(frame.depth_mm.begin(), frame.depth_mm.end(), depth_mm);
    image->depth_mm = depth_mm;
    image->cx = frame.camera.cx;
    return OSSA_OK;
  });
}

ossa_status ossa_project(const ossa_depth_image* image, const float point_m[3], float pixel_uv[2]) {
  return Guarded([&] {
    RequireNotNull(image, "ossa_project", "an image");
    RequireNotNull(point_m, "ossa_project", "a point");
    RequireNotNull(pixel_uv, "ossa_project", "a pixel");
    const ossa::depth::Camera camera = CameraFrom(ReadStruct(*image));
    RequireBefore(point_m[2], "ossa_project", "a point with z");
    const Eigen::Vector2d pixel =
        ossa::depth::Project(camera, Eigen::Vector3f(point_m).cast<double>());
    for (int i = 0; i < 2; ++i) pixel_uv[i] = static_cast<float>(pixel[i]);
    return OSSA_OK;
  });
}

ossa_status ossa_back_project(const ossa_depth_image* image, const float pixel_uv[2],
                              float depth_mm, float point_m[3]) {
  return Guarded([&] {
    RequireNotNull(image, "ossa_back_project", "an image");
    RequireNotNull(pixel_uv, "ossa_back_project", "a pixel");
    RequireNotNull(point_m, "ossa_back_project", "a point");
    const ossa::depth::Camera camera = CameraFrom(ReadStruct(*image));
    RequireBefore(depth_mm, "ossa_back_project", "a depth");
    const Eigen::Vector2d pixel = Eigen::Vector2f(pixel_uv).cast<double>();
    CopyVector(
        ossa::depth::BackProject(camera, pixel.x(), pixel.y(), static_cast<double>(depth_mm)),
        point_m);
    return OSSA_OK;
  });
}

ossa_status ossa_points(const ossa_depth_image* image, float* points_m) {
  return Guarded([&] {
    RequireNotNull(image, "ossa_points", "an image");
    RequireNotNull(points_m, "ossa_points", "points");
    const ossa_depth_image given = ReadStruct(*image);
    RequireNotNull(given.depth_mm, "ossa_points", "depths");
    const ossa::depth::Camera camera = CameraFrom(given);
    const uint16_t* depth_mm = given.depth_mm;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u, ++depth_mm, points_m += 3) {
        CopyVector(ossa::depth::BackProject(camera, u, v, *depth_mm), points_m);
      }
    }
    return OSSA_OK;
  });
}
