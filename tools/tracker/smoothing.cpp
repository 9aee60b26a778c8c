#include "tools/tracker/smoothing.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "depth/base/error.h"

namespace ossa::tracker {
namespace {

void Require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw std::invalid_argument("SmoothingOptions." + std::string(name) + " = " +
                              std::to_string(value) + ", must be in " + range);
}

}  // namespace

void SmoothingOptions::Check() const {
  const auto& [smoothing, correction, prediction, jitter_radius_m, max_deviation_radius_m, _] =
      holt;
  Require(smoothing >= 0 && smoothing < 1, "smoothing", smoothing, "[0, 1)");
  Require(correction >= 0 && correction <= 1, "correction", correction, "[0, 1]");
  Require(prediction >= 0 && prediction < 100, "prediction", prediction, "[0, 100)");
  // With an infinite jitter radius nothing would move, and infinity times 0 is no cutoff.
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  Require(positive(jitter_radius_m), "jitter_radius_m", jitter_radius_m, "(0, inf)");
  Require(max_deviation_radius_m > 0, "max_deviation_radius_m", max_deviation_radius_m, "(0, inf]");
  Require(positive(one_euro.min_cutoff_hz), "min_cutoff_hz", one_euro.min_cutoff_hz, "(0, inf)");
  Require(one_euro.beta_per_m >= 0 && std::isfinite(one_euro.beta_per_m), "beta_per_m",
          one_euro.beta_per_m, "[0, inf)");
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
    o.holt = recon::HoltOptions::Smooth();
  } else if (name == "verysmooth") {
    o.holt = recon::HoltOptions::VerySmooth();
  } else if (name != "default") {
    throw InputError("smoothing '" + std::string(name) +
                     "': expected none, default, smooth, verysmooth or one-euro");
  }
  return o;
}

recon::Posture Smooth(const recon::Posture& raw, double time_s, const SmoothingOptions& options,
                      SmoothingState& state) {
  const std::optional<double> step_s = state.steps.To(time_s);
  const SmoothingKind before = std::exchange(state.kind, options.kind);
  if (options.kind == SmoothingKind::kNone) return raw;
  if (!step_s || before != options.kind) {
    state.holt = {};
    state.one_euro = {};
  }
  recon::Posture result;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Vector3d& p = raw.position_m[j];
    if (options.kind == SmoothingKind::kHolt) {
      state.holt[j].SetOptions(options.holt);
      result.position_m[j] = state.holt[j].Step(p);
    } else {
      state.one_euro[j].SetOptions(options.one_euro);
      result.position_m[j] = state.one_euro[j].Step(p, step_s.value_or(0.0));
    }
  }
  return result;
}

}  // namespace ossa::tracker
