#pragma once
#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "depth/render/active_stereo.h"
#include "depth/render/structured_light.h"
#include "depth/render/time_of_flight.h"

namespace ossa::depth {

/// Sensors that can be simulated; the values of `ossa render --noise`, beside `any`.
enum class SensorKind { kNone, kKinectV1, kXtion, kKinectV2, kAzure, kD4xx };
/// Their names, in that order.
inline constexpr std::array<std::string_view, 6> kSensorNames = {"none",      "kinect-v1", "xtion",
                                                                 "kinect-v2", "azure",     "d4xx"};
std::optional<SensorKind> SensorFromName(std::string_view name);

/// How one sensor errs; nothing: a perfect one.
using SensorModel =
    std::variant<std::monostate, StructuredLightOptions, TimeOfFlightOptions, ActiveStereoOptions>;
SensorModel MakeSensorModel(SensorKind kind);

/// What the renderer must trace for the model: what its projector or second imager reaches.
RenderOptions RaysFor(const SensorModel& model);

/// The rendered image as the sensor delivers it. `camera` is that of the rendered image, the whole
/// one or a crop of `whole`. Every pixel's noise depends on (seed, pixel) only.
SensorImage Simulate(const SensorModel& model, const RenderedImage& rendered, const Camera& camera,
                     const Camera& whole, uint64_t seed);

}  // namespace ossa::depth
