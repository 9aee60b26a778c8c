#include "depth/image/camera.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

// Constants: bounds, far from any camera that exists; chosen by hand.

struct Field {
  const char* name;
  double value, least, most;

  bool IsSane() const { return value >= least && value <= most; }  // false for NaN
};

std::array<Field, 6> FieldsOf(const Camera& camera) {
  constexpr double kLeastFocal_px = 0.1, kMost_px = 1e6;
  return {{{"width", static_cast<double>(camera.width), 1, kLargestImageSide},
           {"height", static_cast<double>(camera.height), 1, kLargestImageSide},
           {"fx", camera.fx, kLeastFocal_px, kMost_px},
           {"fy", camera.fy, kLeastFocal_px, kMost_px},
           {"cx", camera.cx, -kMost_px, kMost_px},
           {"cy", camera.cy, -kMost_px, kMost_px}}};
}

}  // namespace

bool IsSane(const Camera& camera) {
  const auto fields = FieldsOf(camera);
  return std::all_of(fields.begin(), fields.end(), [](const Field& f) { return f.IsSane(); });
}

void CheckCamera(const Camera& camera, const std::string& name) {
  for (const Field& field : FieldsOf(camera)) {
    if (field.IsSane()) continue;
    std::ostringstream message;
    message << name << ": \"" << field.name << "\": expected " << field.least << " to "
            << field.most << ", found " << field.value;
    throw InputError(message.str());
  }
}

Camera KinectV1Camera(int width, int height) {
  const double f = 575.0 * width / 640.0;
  return {width, height, f, f, width / 2.0, height / 2.0};
}

Camera Resized(const Camera& camera, int width, int height) {
  const double sx = static_cast<double>(width) / camera.width;
  const double sy = static_cast<double>(height) / camera.height;
  return {width, height, camera.fx * sx, camera.fy * sy, camera.cx * sx, camera.cy * sy};
}

Camera Cropped(const Camera& camera, int left, int top, int width, int height) {
  return {width, height, camera.fx, camera.fy, camera.cx - left, camera.cy - top};
}

}  // namespace ossa::depth
