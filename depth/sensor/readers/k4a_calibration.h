#pragma once
#include <string>

#include "depth/sensor/readers/lens_camera.h"

namespace ossa::depth {

/// The depth camera from the calibration that k4arecorder attaches to a recording, for images of
/// this size, which identifies the mode of the sensor of 1024 × 1024 pixels. Throws InputError
/// naming the expectation.
LensCamera ReadK4aCalibration(const std::string& json, int width, int height);

}  // namespace ossa::depth
