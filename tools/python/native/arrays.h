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

/// Between NumPy's arrays and ossa's values. What goes out owns its memory; what comes in is looked
/// at where it lies.
namespace ossa::python {

namespace py = pybind11;

/// The values as an array of this shape, row-major, without a copy.
template <typename T>
py::array_t<T> ToArray(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = owner->data();
  const py::capsule capsule(owner.release(),
                            [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), data, capsule);
}

/// A depth image where it lies in memory: uint16 [height, width] of this machine's byte order, rows
/// of neighbouring pixels (a part cut out of a larger image is one). Throws InputError that says
/// what else it is. The array must outlive the view.
depth::DepthView ToView(const py::array& depth_mm);

/// Pixels to work on, bool or uint8 [height, width] like the image's: where it is not 0 and the
/// image has a reading. None: all readings. Row-major indices, ascending.
std::vector<int32_t> ListPixels(const depth::DepthView& depth, const py::object& mask);

/// (fx, fy, cx, cy, width, height) of ossa.Camera for an image of the view's size. Throws
/// InputError for a camera that cannot be.
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
