#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "recon/posture.h"

namespace ossa::tracker {

/// The filter that joints go through at the end.
enum class SmoothingKind { kNone, kHolt, kOneEuro };

/// The Kinect SDK's NUI_TRANSFORM_SMOOTH_PARAMETERS (Holt double exponential; Azimi, "Skeletal
/// Joint Smoothing White Paper", Microsoft 2012), and One-Euro (Casiez et al. 2012).
struct SmoothingOptions {
  SmoothingKind kind = SmoothingKind::kHolt;
  double smoothing = 0.5;                // [0, 1): 0 = raw; 1 - alpha of the paper
  double correction = 0.5;               // [0, 1]: trend gain gamma
  double prediction = 0.5;               // frames to predict into the future, >= 0
  double jitter_radius_m = 0.05;         // movements below are damped further, > 0
  double max_deviation_radius_m = 0.04;  // filtered never farther than this from raw, > 0
  double min_cutoff_hz = 1.5;            // One-Euro: cutoff at rest, > 0
  double beta_per_m = 4.0;               // One-Euro: cutoff grows by this per m/s, >= 0
  void Check() const;                    // throws std::invalid_argument with name, value and range
};

/// Published presets: none, default (0.5 0.5 0.5 0.05 0.04), smooth (0.5 0.1 0.5 0.1 0.1),
/// verysmooth (0.7 0.3 1.0 1.0 1.0), one-euro. Throws InputError for another name.
SmoothingOptions SmoothingPreset(std::string_view name);
/// Their names.
const std::vector<std::string>& SmoothingPresets();

/// State of one body's filter.
struct SmoothingState {
  recon::Posture filtered, trend, raw;
  int frames = 0;
  double time_s = 0.0;
};

/// One step; a gap of more than half a second starts anew.
recon::Posture Smooth(const recon::Posture& raw, double time_s, const SmoothingOptions& options,
                      SmoothingState& state);

}  // namespace ossa::tracker
