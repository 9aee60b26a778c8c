#include "depth/sensor/readers/k4a_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

using nlohmann::json;

constexpr const char* kName = "the attached calibration";

// How a mode's image is cropped from the sensor's, which may have been binned by 2 first (Azure
// Kinect SDK, transformation_get_mode_specific_depth_camera_calibration).
struct Mode {
  int width, height;
  int sensor_px;  // side of the full image
  int left, top;
};
constexpr std::array<Mode, 4> kModes = {{{320, 288, 512, 96, 90},
                                         {640, 576, 1024, 192, 180},
                                         {512, 512, 512, 0, 0},
                                         {1024, 1024, 1024, 0, 0}}};

[[noreturn]] void Fail(const std::string& expected) {
  throw InputError(std::string(kName) + ": expected " + expected);
}

json FindDepthCamera(const json& calibration) {
  const json::json_pointer place("/CalibrationInformation/Cameras");
  if (!calibration.contains(place) || !calibration.at(place).is_array()) {
    Fail("CalibrationInformation with Cameras");
  }
  for (const json& camera : calibration.at(place)) {
    if (camera.is_object() && camera.value("Purpose", json()) == "CALIBRATION_CameraPurposeDepth") {
      return camera;
    }
  }
  Fail("a camera whose Purpose is CALIBRATION_CameraPurposeDepth");
}

// cx cy fx fy k1 ... k6 codx cody p2 p1; the first four relative to the sensor's size.
std::array<double, 14> ReadParameters(const json& camera) {
  const json::json_pointer place("/Intrinsics/ModelParameters");
  std::array<double, 14> parameters{};
  if (!camera.contains(place) || !camera.at(place).is_array() ||
      camera.at(place).size() < parameters.size()) {
    Fail("Intrinsics with 14 ModelParameters");
  }
  for (size_t i = 0; i < parameters.size(); ++i) {
    const json& value = camera.at(place)[i];
    if (!value.is_number() || !std::isfinite(value.get<double>())) Fail("finite ModelParameters");
    parameters[i] = value.get<double>();
  }
  return parameters;
}

}  // namespace

LensCamera ReadK4aCalibration(const std::string& text, int width, int height) {
  constexpr double kUsualRadius = 1.7;  // x/z and y/z, a ratio; default, by the SDK
  const json calibration = json::parse(text, nullptr, false);
  if (calibration.is_discarded()) Fail("JSON");
  const json camera = FindDepthCamera(calibration);
  const auto mode = std::find_if(kModes.begin(), kModes.end(), [&](const Mode& m) {
    return m.width == width && m.height == height;
  });
  if (mode == kModes.end()) {
    Fail("a depth mode of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
  }
  const auto p = ReadParameters(camera);
  LensCamera lens;
  // The SDK's origin is the corner of the first pixel, ours its centre.
  lens.pinhole = {width,
                  height,
                  p[2] * mode->sensor_px,
                  p[3] * mode->sensor_px,
                  p[0] * mode->sensor_px - mode->left - 0.5,
                  p[1] * mode->sensor_px - mode->top - 0.5};
  CheckCamera(lens.pinhole, kName);
  lens.k1 = p[4], lens.k2 = p[5], lens.k3 = p[6];
  lens.k4 = p[7], lens.k5 = p[8], lens.k6 = p[9];
  lens.p2 = p[12], lens.p1 = p[13];
  const json radius = camera.value("MetricRadius", json(0.0));
  lens.largest_radius = radius.is_number() ? radius.get<double>() : 0.0;
  if (!(lens.largest_radius > 0)) lens.largest_radius = kUsualRadius;
  return lens;
}

}  // namespace ossa::depth
