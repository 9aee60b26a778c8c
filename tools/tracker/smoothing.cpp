#include "tools/tracker/smoothing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "depth/base/error.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument("SmoothingOptions." + std::string(name) + " = " +
                              std::to_string(value) + ", must be in " + range);
}

// The white paper's filter for one joint, in the SDK's order of steps: jitter damping, level,
// trend, prediction, deviation clamp.
Vector3d HoltStep(const Vector3d& raw, size_t joint, const SmoothingOptions& o,
                  SmoothingState& state) {
  Vector3d& level = state.filtered.position_m[joint];
  Vector3d& trend = state.trend.position_m[joint];
  Vector3d filtered, new_trend;
  if (state.frames == 0) {
    filtered = raw;
    new_trend = Vector3d::Zero();
  } else if (state.frames == 1) {
    filtered = 0.5 * (raw + state.raw.position_m[joint]);
    new_trend = (filtered - level) * o.correction + trend * (1 - o.correction);
  } else {
    const double moved = (raw - level).norm();
    const double share = std::min(1.0, moved / o.jitter_radius_m);
    const Vector3d damped = raw * share + level * (1 - share);
    filtered = damped * (1 - o.smoothing) + (level + trend) * o.smoothing;
    new_trend = (filtered - level) * o.correction + trend * (1 - o.correction);
  }
  Vector3d predicted = filtered + o.prediction * new_trend;
  const double off = (predicted - raw).norm();
  if (off > o.max_deviation_radius_m)
    predicted = raw + (predicted - raw) * (o.max_deviation_radius_m / off);
  level = filtered;
  trend = new_trend;
  return predicted;
}

double LowPassShare(double cutoff_hz, double dt_s) {
  const double tau_s = 1.0 / (2 * std::numbers::pi * cutoff_hz);
  return 1.0 / (1.0 + tau_s / dt_s);
}

Vector3d OneEuroStep(const Vector3d& raw, size_t joint, double dt_s, const SmoothingOptions& o,
                     SmoothingState& state) {
  Vector3d& filtered = state.filtered.position_m[joint];
  Vector3d& speed = state.trend.position_m[joint];
  if (state.frames == 0) {
    filtered = raw;
    speed = Vector3d::Zero();
    return raw;
  }
  constexpr double kSpeedCutoff_hz = 1.0;  // of the paper
  speed +=
      LowPassShare(kSpeedCutoff_hz, dt_s) * ((raw - state.raw.position_m[joint]) / dt_s - speed);
  filtered += LowPassShare(o.min_cutoff_hz + o.beta_per_m * speed.norm(), dt_s) * (raw - filtered);
  return filtered;
}

}  // namespace

void SmoothingOptions::Check() const {
  Require(smoothing >= 0 && smoothing < 1, "smoothing", smoothing, "[0, 1)");
  Require(correction >= 0 && correction <= 1, "correction", correction, "[0, 1]");
  Require(prediction >= 0 && prediction < 100, "prediction", prediction, "[0, 100)");
  Require(jitter_radius_m > 0, "jitter_radius_m", jitter_radius_m, "(0, inf)");
  Require(max_deviation_radius_m > 0, "max_deviation_radius_m", max_deviation_radius_m, "(0, inf)");
  Require(min_cutoff_hz > 0, "min_cutoff_hz", min_cutoff_hz, "(0, inf)");
  Require(beta_per_m >= 0, "beta_per_m", beta_per_m, "[0, inf)");
}

const std::vector<std::string>& SmoothingPresets() {
  static const std::vector<std::string> names = {"none", "default", "smooth", "verysmooth",
                                                 "one-euro"};
  return names;
}

SmoothingOptions SmoothingPreset(std::string_view name) {
  SmoothingOptions o;
  if (name == "none") {
    o.kind = SmoothingKind::kNone;
  } else if (name == "one-euro") {
    o.kind = SmoothingKind::kOneEuro;
  } else if (name == "smooth") {
    o.correction = 0.1, o.jitter_radius_m = 0.1, o.max_deviation_radius_m = 0.1;
  } else if (name == "verysmooth") {
    o.smoothing = 0.7, o.correction = 0.3, o.prediction = 1.0;
    o.jitter_radius_m = 1.0, o.max_deviation_radius_m = 1.0;
  } else if (name != "default") {
    throw InputError("smoothing '" + std::string(name) +
                     "': expected none, default, smooth, verysmooth or one-euro");
  }
  return o;
}

recon::Posture Smooth(const recon::Posture& raw, double time_s, const SmoothingOptions& options,
                      SmoothingState& state) {
  if (options.kind == SmoothingKind::kNone) return raw;
  const double dt_s = time_s - state.time_s;
  if (state.frames > 0 && (dt_s <= 0 || dt_s > 0.5)) state = {};
  recon::Posture result;
  for (size_t j = 0; j < raw.position_m.size(); ++j) {
    const Vector3d& p = raw.position_m[j];
    result.position_m[j] = options.kind == SmoothingKind::kHolt
                               ? HoltStep(p, j, options, state)
                               : OneEuroStep(p, j, dt_s, options, state);
  }
  state.raw = raw;
  state.time_s = time_s;
  ++state.frames;
  return result;
}

}  // namespace ossa::tracker
