#include "tools/python/native/arrays.h"

#include "depth/base/error.h"

namespace ossa::python {
namespace {

std::string ShapeOf(const py::array& array) {
  return py::str(py::make_tuple(py::str(array.dtype()), array.attr("shape"))).cast<std::string>();
}

bool IsMask(const py::array& mask, const depth::DepthView& depth) {
  const bool fits =
      mask.ndim() == 2 && mask.shape(0) == depth.height && mask.shape(1) == depth.width;
  return fits && mask.itemsize() == 1 && (mask.dtype().kind() == 'b' || mask.dtype().kind() == 'u');
}

}  // namespace

depth::DepthView ToView(const py::array& depth_mm) {
  if (!py::isinstance<py::array_t<uint16_t>>(depth_mm) || depth_mm.ndim() != 2) {
    throw InputError("depth_mm: expected uint16 [height, width], found " + ShapeOf(depth_mm));
  }
  const py::ssize_t height = depth_mm.shape(0), width = depth_mm.shape(1);
  if (width < 1 || height < 1 || width > depth::kLargestImageSide ||
      height > depth::kLargestImageSide) {
    throw InputError("depth_mm: expected 1 to " + std::to_string(depth::kLargestImageSide) +
                     " rows and columns, found " + ShapeOf(depth_mm));
  }
  constexpr py::ssize_t kPixel = sizeof(uint16_t);
  const py::ssize_t row = depth_mm.strides(0);
  const bool neighbours = width == 1 || depth_mm.strides(1) == kPixel;
  const bool downwards = height == 1 || (row >= width * kPixel && row % kPixel == 0);
  const bool aligned = reinterpret_cast<uintptr_t>(depth_mm.data()) % alignof(uint16_t) == 0;
  if (!neighbours || !downwards || !aligned) {
    throw InputError(
        "depth_mm: expected rows of neighbouring pixels from the top down (C order), found strides "
        "of " +
        py::str(depth_mm.attr("strides")).cast<std::string>() +
        " bytes: numpy.ascontiguousarray(depth_mm) has them");
  }
  const py::ssize_t stride = height == 1 ? width : row / kPixel;
  return {static_cast<const uint16_t*>(depth_mm.data()), static_cast<int>(width),
          static_cast<int>(height), static_cast<int>(stride)};
}

std::vector<int32_t> ListPixels(const depth::DepthView& depth, const py::object& mask) {
  std::optional<py::array> given;
  if (!mask.is_none()) {
    given = py::cast<py::array>(mask);
    if (!IsMask(*given, depth)) {
      throw InputError("mask: expected bool or uint8 of the image's size, [" +
                       std::to_string(depth.height) + ", " + std::to_string(depth.width) +
                       "], found " + ShapeOf(*given));
    }
  }
  std::vector<int32_t> pixels;
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const bool chosen = !given || *static_cast<const uint8_t*>(given->data(v, u)) != 0;
      if (chosen && depth.at(u, v) != 0) pixels.push_back(v * depth.width + u);
    }
  }
  return pixels;
}

depth::Camera ToCamera(const py::tuple& camera, const depth::DepthView& depth) {
  const auto number = [&](size_t i) { return camera[i].cast<double>(); };
  depth::Camera chosen;
  chosen.fx = number(0);
  chosen.fy = number(1);
  chosen.cx = number(2);
  chosen.cy = number(3);
  chosen.width = camera[4].cast<int>();
  chosen.height = camera[5].cast<int>();
  const depth::Camera fitting = depth::CameraForSize(chosen, depth.width, depth.height);
  depth::CheckCamera(fitting, "camera");
  return fitting;
}

py::tuple ToTuple(const depth::Camera& camera) {
  return py::make_tuple(camera.fx, camera.fy, camera.cx, camera.cy, camera.width, camera.height);
}

py::array_t<double> ToArray(const recon::Posture& posture) {
  std::vector<double> values;
  values.reserve(3 * recon::kJointCount);
  for (const Eigen::Vector3d& p : posture.position_m)
    values.insert(values.end(), p.begin(), p.end());
  return ToArray(std::move(values), {recon::kJointCount, 3});
}

py::array_t<double> ToArray(const recon::JointArray<double>& values) {
  return ToArray(std::vector<double>(values.begin(), values.end()), {recon::kJointCount});
}

py::array_t<double> ToArray(const recon::JointOrientations& orientations) {
  std::vector<double> values;
  values.reserve(4 * recon::kJointCount);
  for (const Eigen::Quaterniond& q : orientations) {
    values.insert(values.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  return ToArray(std::move(values), {recon::kJointCount, 4});
}

py::array_t<int8_t> ToArray(const recon::JointArray<recon::TrackingState>& states) {
  std::vector<int8_t> values;
  for (const recon::TrackingState state : states) values.push_back(static_cast<int8_t>(state));
  return ToArray(std::move(values), {recon::kJointCount});
}

}  // namespace ossa::python
