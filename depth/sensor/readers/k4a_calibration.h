#pragma once
#include <string>

#include "depth/sensor/readers/lens_camera.h"

namespace ossa::depth {

/// The depth camera of a calibration that k4arecorder attached to a recording, for images of this
/// size: which mode of the sensor of 1024 × 1024 pixels they are of. Throws InputError naming what
/// was expected.
LensCamera ReadK4aCalibration(const std::string& json, int width, int height);

}  // namespace ossa::depth
