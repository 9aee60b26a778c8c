#include "depth/sensor/openni2/openni_depth_internal.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <sstream>

#include "depth/base/error.h"
#include "depth/sensor/openni2/delivered_depth.h"
#include "depth/sensor/shutdown_gate_internal.h"

namespace ossa::depth {
namespace {

// Constants: bounds of a field of view, by hand.

// OpenNI2 counts initialisations without locking.
std::mutex& SessionMutex() {
  static std::mutex mutex;
  return mutex;
}

ImageWindow WholeImage(int width, int height) { return {width, height, 0, 0, width, height}; }

// OpenNI2 gives a window's position in the delivered image: if that is mirrored, from the other
// side.
ImageWindow TurnedBack(ImageWindow window, bool mirrored) {
  if (mirrored) window.left = window.whole_width - window.left - window.width;
  return window;
}

}  // namespace

OpenNiSession::OpenNiSession() {
  const std::lock_guard lock(SessionMutex());
  if (openni::OpenNI::initialize() != openni::STATUS_OK) {
    throw InputError("OpenNI2: cannot be started: " + OpenNiError());
  }
}

OpenNiSession::~OpenNiSession() {
  const std::lock_guard lock(SessionMutex());
  const ShutdownGateClosed closed;
  openni::OpenNI::shutdown();
}

std::string OpenNiError() {
  // Lines of increasing generality, each ended by tabs and newlines: the first is the most
  // specific.
  std::istringstream words(openni::OpenNI::getExtendedError());
  std::string text;
  for (std::string word; words >> word;) {
    if (word == "DeviceOpen:" && !text.empty()) break;
    text += (text.empty() ? "" : " ") + word;
  }
  return text.empty() ? "no reason given" : text;
}

std::vector<uint16_t> ReadMillimetres(const openni::VideoFrameRef& frame, bool mirrored) {
  const auto format = frame.getVideoMode().getPixelFormat();
  const bool tenths = format == openni::PIXEL_FORMAT_DEPTH_100_UM;
  if (format != openni::PIXEL_FORMAT_DEPTH_1_MM && !tenths) {
    throw InputError("expected depths in millimetres, found pixel format " +
                     std::to_string(static_cast<int>(format)));
  }
  return MillimetresOf({frame.getData(), frame.getWidth(), frame.getHeight(),
                        frame.getStrideInBytes(), frame.getDataSize(), tenths, mirrored});
}

ImageWindow ReadWindow(const openni::VideoFrameRef& frame, bool mirrored) {
  const int width = frame.getWidth(), height = frame.getHeight();
  if (!frame.getCroppingEnabled()) return WholeImage(width, height);
  const openni::VideoMode mode = frame.getVideoMode();
  const ImageWindow window{mode.getResolutionX(),
                           mode.getResolutionY(),
                           frame.getCropOriginX(),
                           frame.getCropOriginY(),
                           width,
                           height};
  if (!window.IsSane()) {
    const auto two = [](int a, const char* between, int b) {
      return std::to_string(a) + between + std::to_string(b);
    };
    throw InputError("expected a part of the " + two(window.whole_width, "x", window.whole_height) +
                     " image, found " + two(width, "x", height) + " from pixel (" +
                     two(window.left, ", ", window.top) + ") on");
  }
  return TurnedBack(window, mirrored);
}

ImageWindow ReadWindow(const openni::VideoStream& stream, bool mirrored) {
  const openni::VideoMode mode = stream.getVideoMode();
  ImageWindow window = WholeImage(mode.getResolutionX(), mode.getResolutionY());
  const bool cropped = stream.getCropping(&window.left, &window.top, &window.width, &window.height);
  if (!cropped || !window.IsSane()) return WholeImage(window.whole_width, window.whole_height);
  return TurnedBack(window, mirrored);
}

Camera CameraFromFieldOfView(int width, int height, double horizontal_rad, double vertical_rad) {
  const auto focal = [](int pixels, double fov_rad) {
    return pixels / (2 * std::tan(fov_rad / 2));
  };
  constexpr double kLeast_rad = 0.01;
  constexpr double kMost_rad = 3.1;
  const bool known = horizontal_rad > kLeast_rad && horizontal_rad < kMost_rad &&
                     vertical_rad > kLeast_rad && vertical_rad < kMost_rad;
  if (!known) return KinectV1Camera(width, height);
  return {width,       height,      focal(width, horizontal_rad), focal(height, vertical_rad),
          width / 2.0, height / 2.0};
}

}  // namespace ossa::depth
