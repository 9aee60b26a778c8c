#include "depth/render/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace ossa::depth {
namespace {

// Constants: by data sheet unless stated otherwise.

StructuredLightOptions Xtion() {
  StructuredLightOptions xtion;
  // The same chip and quantisation as a Kinect v1. Its noise is half a step (Khoshelham & Elberink
  // 2012), and hardly any pixel inside a surface is lost: measured on ITOP's frames (`ossa
  // experiment sensor`).
  xtion.disparity_noise_px = 0.062;
  xtion.dropout = 0.00001;
  xtion.lateral_noise_px = 0.6;  // by hand
  return xtion;
}

TimeOfFlightOptions Azure() {
  TimeOfFlightOptions azure;
  // Standard deviation of at most 17 mm up to 3.86 m (Microsoft's hardware specification, confirmed
  // by Tölgyessy et al. 2021); much less in the image centre: measured on a recording (`ossa
  // experiment sensor`), which has no mixed pixels, either.
  azure.noise_m = 0.0006;
  azure.noise_per_m2 = 0.00008;
  azure.fall_off = 2.5;
  azure.found_out = 0.98;
  azure.least_light = 0.006;  // by hand: dark cloth, 0.05, begins to fail at 2.5 m
  azure.reach_x_deg = 37.5;   // NFOV's field of interest is 75 x 65 degrees, the same specification
  azure.reach_y_deg = 32.5;
  azure.nearest_m = 0.25;
  azure.farthest_m = 5.46;
  return azure;
}

}  // namespace

std::optional<SensorKind> SensorFromName(std::string_view name) {
  const auto at = std::find(kSensorNames.begin(), kSensorNames.end(), name);
  if (at == kSensorNames.end()) return std::nullopt;
  return static_cast<SensorKind>(at - kSensorNames.begin());
}

SensorModel MakeSensorModel(SensorKind kind) {
  switch (kind) {
    case SensorKind::kNone:
      break;
    case SensorKind::kKinectV1:
      return StructuredLightOptions{};
    case SensorKind::kXtion:
      return Xtion();
    case SensorKind::kKinectV2:
      return TimeOfFlightOptions{};
    case SensorKind::kAzure:
      return Azure();
    case SensorKind::kD4xx:
      return ActiveStereoOptions{};
  }
  return std::monostate{};
}

RenderOptions RaysFor(const SensorModel& model) {
  if (const auto* light = std::get_if<StructuredLightOptions>(&model)) {
    return {.projector = true, .baseline_m = light->baseline_m};
  }
  if (const auto* stereo = std::get_if<ActiveStereoOptions>(&model)) {
    return {.projector = true, .baseline_m = stereo->baseline_m};
  }
  return {};
}

SensorImage Simulate(const SensorModel& model, const RenderedImage& rendered, const Camera& camera,
                     const Camera& whole, uint64_t seed) {
  if (const auto* light = std::get_if<StructuredLightOptions>(&model)) {
    StructuredLightOptions options = *light;
    options.whole_width_px = whole.width;
    return SimulateStructuredLight(rendered, camera, options, seed);
  }
  if (const auto* flight = std::get_if<TimeOfFlightOptions>(&model)) {
    TimeOfFlightOptions options = *flight;
    options.whole_width_px = whole.width;
    return SimulateTimeOfFlight(rendered, camera, options, seed);
  }
  if (const auto* stereo = std::get_if<ActiveStereoOptions>(&model)) {
    return SimulateActiveStereo(rendered, camera, whole, *stereo, seed);
  }
  return PerfectSensor(rendered);
}

SensorImage PerfectSensor(const RenderedImage& rendered) {
  const int w = rendered.depth_m.width;
  const int h = rendered.depth_m.height;
  SensorImage image{{w, h}, {w, h, -1}};
  for (size_t i = 0; i < rendered.depth_m.data.size(); ++i) {
    const float depth_mm = rendered.depth_m.data[i] * 1000.0F;
    if (depth_mm < 0.5F || depth_mm > 65534.0F) continue;
    image.depth_mm.data[i] = static_cast<uint16_t>(std::lround(depth_mm));
    image.source.data[i] = static_cast<int32_t>(i);
  }
  return image;
}

}  // namespace ossa::depth
