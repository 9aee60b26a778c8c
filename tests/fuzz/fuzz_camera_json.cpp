// camera.json, calibrations and --camera: any text is a camera or an InputError of one line.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "depth/base/error.h"
#include "depth/image/calibration_text.h"
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
  return {
      depth::CameraToJson(depth::KinectV1Camera(640, 480)),
      "kinect-v1",
      "575,575,320,240",
      "cam0:\n  camera_model: pinhole\n  intrinsics: [575, 575, 320, 240]\n  resolution: [1, 1]\n",
      "# cameras\n1 OPENCV 640 480 575 575 320 240 0.1 0 0 0\n",
      "image_width: 640\nK:\n  data: [575, 0, 320, 0, 575, 240, 0, 0, 1]\nD:\n- 0.1\n- 0\n"};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  ExpectCameraOrInputError([&] { return ossa::depth::CameraFromJson(text, "camera.json"); });
  try {
    const auto calibration = ossa::depth::FindCalibration(text, "ost.yaml");
    if (calibration) ossa::depth::ComputeCornerShift(*calibration);
  } catch (const ossa::InputError&) {
  }
  using Read = std::optional<ossa::depth::Calibration> (*)(const std::string&, const std::string&);
  for (const Read read : {&ossa::depth::ReadKalibrCamera, &ossa::depth::ReadColmapCameras}) {
    try {
      if (const auto camera = read(text, "cameras")) ossa::depth::ComputeCornerShift(*camera);
    } catch (const ossa::InputError&) {
    }
  }
  ExpectCameraOrInputError(
      [&] { return ossa::depth::CameraForSize(ossa::depth::ParseCamera(text), 640, 480); });
  return 0;
}
