#pragma once
// Helpers around OpenNI2's C++ interface, shared by the device source and the .oni reader.
#include <OpenNI.h>

#include <cstdint>
#include <string>
#include <vector>

#include "depth/image/camera.h"
#include "depth/sensor/image_window_internal.h"
#include "depth/sensor/openni2/openni_session.h"

namespace ossa::depth {

/// OpenNI2's account of its last error, as one line.
std::string OpenNiError();

/// Millimetres of a depth frame, whole or cropped: 100-µm depths are rounded, mirrored images
/// turned back. Throws InputError for pixel formats without depths.
std::vector<uint16_t> ReadMillimetres(const openni::VideoFrameRef& frame, bool mirrored);

/// What ReadMillimetres's result shows of the image turned back. Throws InputError for a window
/// that is not within the image.
ImageWindow ReadWindow(const openni::VideoFrameRef& frame, bool mirrored);

/// The same as the stream has it for its frames to come; the whole image where it says nonsense.
ImageWindow ReadWindow(const openni::VideoStream& stream, bool mirrored);

/// The pinhole camera of a field of view, centre of the image.
Camera CameraFromFieldOfView(int width, int height, double horizontal_rad, double vertical_rad);

}  // namespace ossa::depth
