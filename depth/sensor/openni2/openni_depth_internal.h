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

/// OpenNI2's last error, as one line.
std::string OpenNiError();

/// Millimetres of a depth frame, full or cropped: 100-µm depths are rounded, mirrored images
/// reversed. Throws InputError for pixel formats without depth.
std::vector<uint16_t> ReadMillimetres(const openni::VideoFrameRef& frame, bool mirrored);

/// The window of ReadMillimetres's result in the unmirrored image. Throws InputError if it is not
/// within the image.
ImageWindow ReadWindow(const openni::VideoFrameRef& frame, bool mirrored);

/// The window of the stream's following frames; the full image if it is invalid.
ImageWindow ReadWindow(const openni::VideoStream& stream, bool mirrored);

/// The pinhole camera with this field of view and a centred principal point.
Camera CameraFromFieldOfView(int width, int height, double horizontal_rad, double vertical_rad);

}  // namespace ossa::depth
