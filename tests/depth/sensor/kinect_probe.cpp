// kinect_probe URI: opens a Kinect with OpenNI2 only, as a program that knows nothing of ossa
// except the property numbers of its driver, and prints what it gets. A separate program, because
// tests run it with fakenect's libfreenect instead of the real one.
#include <OpenNI.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "depth/sensor/drivers/kinect_properties.h"

namespace {

bool PrintProperties(openni::Device& device) {
  std::array<char, 256> serial{};
  int size = static_cast<int>(serial.size());
  if (device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, serial.data(), &size) !=
      openni::STATUS_OK) {
    return false;
  }
  double tilt_deg = -1.0;
  std::array<double, 3> xyz_mps2{};
  if (device.getProperty(ossa::depth::kKinectTiltProperty, &tilt_deg) != openni::STATUS_OK ||
      device.getProperty(ossa::depth::kKinectAccelProperty, &xyz_mps2) != openni::STATUS_OK) {
    return false;
  }
  const bool tilts =
      device.setProperty(ossa::depth::kKinectTiltProperty, 10.0) == openni::STATUS_OK;
  const bool too_far =
      device.setProperty(ossa::depth::kKinectTiltProperty, 60.0) == openni::STATUS_OK;
  std::printf("serial %s\ntilt %.1f\naccelerometer %.2f %.2f %.2f\n", serial.data(), tilt_deg,
              xyz_mps2[0], xyz_mps2[1], xyz_mps2[2]);
  std::printf("tilts to 10: %d, to 60: %d\n", tilts ? 1 : 0, too_far ? 1 : 0);
  return true;
}

// Prints whether the depth image is registered, and its focal length by the stream's angle of view.
void PrintView(const openni::Device& device, const openni::VideoStream& stream) {
  constexpr double kHalfWidth_px = 320.0;
  std::printf("registered %d, f %.0f\n",
              device.getImageRegistrationMode() == openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR,
              kHalfWidth_px / std::tan(stream.getHorizontalFieldOfView() / 2));
}

// Prints the views of both cameras.
bool PrintViews(openni::Device& device, openni::VideoStream& stream) {
  stream.stop();
  PrintView(device, stream);
  if (device.setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR) !=
      openni::STATUS_OK) {
    return false;
  }
  PrintView(device, stream);
  return true;
}

// Waits for a frame: fakenect provides the accelerometer only while it plays.
bool PrintStream(openni::Device& device, openni::VideoStream& stream) {
  openni::VideoStream* streams = &stream;
  int ready = -1;
  if (stream.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK ||
      stream.start() != openni::STATUS_OK ||
      openni::OpenNI::waitForAnyStream(&streams, 1, &ready, 5000) != openni::STATUS_OK) {
    return false;
  }
  const openni::VideoMode mode = stream.getVideoMode();
  std::printf("stream %dx%d, %d Hz, millimetres %d, below %d\n", mode.getResolutionX(),
              mode.getResolutionY(), mode.getFps(),
              mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM ? 1 : 0,
              stream.getMaxPixelValue());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  openni::OpenNI::initialize();
  int status = 1;
  {
    openni::Device device;
    openni::VideoStream stream;
    if (device.open(argv[1]) == openni::STATUS_OK && PrintStream(device, stream) &&
        PrintProperties(device) && PrintViews(device, stream)) {
      status = 0;
    } else {
      std::printf("%s\n", openni::OpenNI::getExtendedError());
    }
    stream.destroy();
  }
  openni::OpenNI::shutdown();
  return status;
}
