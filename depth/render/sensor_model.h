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
/// Their names, in the same order.
inline constexpr std::array<std::string_view, 6> kSensorNames = {"none",      "kinect-v1", "xtion",
                                                                 "kinect-v2", "azure",     "d4xx"};
std::optional<SensorKind> SensorFromName(std::string_view name);

/// Error model of a sensor; monostate: no errors.
using SensorModel =
    std::variant<std::monostate, StructuredLightOptions, TimeOfFlightOptions, ActiveStereoOptions>;
SensorModel MakeSensorModel(SensorKind kind);

/// Render options for a model: the rays of its projector or second imager.
RenderOptions RaysFor(const SensorModel& model);

/// Simulates the sensor. `camera` is that of the rendered image, either the whole one or a crop of
/// `whole`. The noise of a pixel depends on (seed, pixel) only.
SensorImage Simulate(const SensorModel& model, const RenderedImage& rendered, const Camera& camera,
                     const Camera& whole, uint64_t seed);

}  // namespace ossa::depth
