// camera.json and --camera: any text is a camera or an InputError of one line.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "tests/fuzz/seeds.h"

namespace {

template <typename Parse>
void ExpectCameraOrInputError(const Parse& parse) {
  try {
    const ossa::depth::Camera camera = parse();
    if (!(camera.fx > 0) || !(camera.fy > 0) || !std::isfinite(camera.cx + camera.cy)) abort();
  } catch (const ossa::InputError&) {
  }
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  return {depth::CameraToJson(depth::KinectV1Camera(640, 480)), "kinect-v1", "575,575,320,240"};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  ExpectCameraOrInputError([&] { return ossa::depth::CameraFromJson(text, "camera.json"); });
  ExpectCameraOrInputError(
      [&] { return ossa::depth::CameraForSize(ossa::depth::ParseCamera(text), 640, 480); });
  return 0;
}
