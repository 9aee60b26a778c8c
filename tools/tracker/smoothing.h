#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "recon/filters/joint_filters.h"
#include "recon/posture.h"

namespace ossa::tracker {

enum class SmoothingKind { kNone, kHolt, kOneEuro };

/// A filter of each joint: as the Kinect SDK's (Holt), or One-Euro.
struct SmoothingOptions {
  SmoothingKind kind = SmoothingKind::kHolt;
  recon::HoltOptions holt;
  recon::OneEuroOptions one_euro;
  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// Published presets: none, default (0.5 0.5 0.5 0.05 0.04), smooth (0.5 0.1 0.5 0.1 0.1),
/// verysmooth (0.7 0.3 1.0 1.0 1.0), one-euro. Throws InputError for another name.
SmoothingOptions SmoothingPreset(std::string_view name);
const std::vector<std::string>& SmoothingPresets();

/// The preset that goes with a method of reconstruction when none is asked for: best filters
/// already, a second filter would only lag; the others get the SDK's default.
std::string_view UsualSmoothing(std::string_view method);

/// State of one body's filters.
struct SmoothingState {
  recon::JointArray<recon::HoltFilter> holt;
  recon::JointArray<recon::OneEuroFilter> one_euro;
  bool started = false;
  double time_s = 0.0;
};

/// One step; a gap of more than half a second starts anew.
recon::Posture Smooth(const recon::Posture& raw, double time_s, const SmoothingOptions& options,
                      SmoothingState& state);

}  // namespace ossa::tracker
