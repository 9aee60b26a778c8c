#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "depth/image/camera_presets.h"
#include "depth/image/depth_frame.h"
#include "recon/posture.h"

/// Converts between NumPy arrays and ossa's values. Returned arrays own their memory; input arrays
/// are viewed without a copy.
namespace ossa::python {

namespace py = pybind11;

/// The values as a row-major array of this shape; moved, not copied.
template <typename T>
py::array_t<T> ToArray(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = owner->data();
  const py::capsule capsule(owner.release(),
                            [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), data, capsule);
}

/// A view of a depth image: uint16 [height, width] in native byte order, pixels of a row contiguous
/// (a slice of a larger image is allowed). Throws InputError that names the actual type and shape.
/// The array must outlive the view.
depth::DepthView ToView(const py::array& depth_mm);

/// Row-major indices, ascending, of the pixels that have a reading and whose mask, bool or uint8
/// [height, width], is not 0. None: all pixels with a reading.
std::vector<int32_t> ListPixels(const depth::DepthView& depth, const py::object& mask);

/// (fx, fy, cx, cy, width, height) of ossa.Camera for an image of the view's size. Throws
/// InputError for an invalid camera.
depth::Camera ToCamera(const py::tuple& camera, const depth::DepthView& depth);
py::tuple ToTuple(const depth::Camera& camera);

/// float64 [20, 3], metres.
py::array_t<double> ToArray(const recon::Posture& posture);
/// float64 [20].
py::array_t<double> ToArray(const recon::JointArray<double>& values);
/// float64 [20, 4], w x y z.
py::array_t<double> ToArray(const recon::JointOrientations& orientations);
/// int8 [20]: 0 not tracked, 1 inferred, 2 tracked.
py::array_t<int8_t> ToArray(const recon::JointArray<recon::TrackingState>& states);

}  // namespace ossa::python
