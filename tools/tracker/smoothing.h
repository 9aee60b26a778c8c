#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "recon/filters/frame_steps.h"
#include "recon/filters/joint_filters.h"
#include "recon/posture.h"

namespace ossa::tracker {

// Constants: Kinect SDK 1.8, TransformSmoothParameters; One-Euro's after Casiez 2012, by hand.

/// The filter of the final joints.
enum class SmoothingKind { kNone, kHolt, kOneEuro };

/// The filter of each joint: as the Kinect SDK's (Holt), or One-Euro.
struct SmoothingOptions {
  SmoothingKind kind = SmoothingKind::kHolt;
  recon::HoltOptions holt;
  recon::OneEuroOptions one_euro;
  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// Published presets: none, default (0.5 0.5 0.5 0.05 0.04), smooth (0.5 0.1 0.5 0.1 0.1),
/// verysmooth (0.7 0.3 1.0 1.0 1.0), one-euro. Throws InputError for another name.
SmoothingOptions SmoothingPreset(std::string_view name);
/// The names of the presets.
const std::vector<std::string>& SmoothingPresets();

/// State of one body's filters.
struct SmoothingState {
  recon::JointArray<recon::HoltFilter> holt;
  recon::JointArray<recon::OneEuroFilter> one_euro;
  SmoothingKind kind = SmoothingKind::kNone;  // kind of the last frame
  recon::FrameSteps steps;
};

/// Filters one frame. Restarts after a gap, when time runs backwards (recon::FrameSteps) and when
/// the kind of filter changed.
recon::Posture Smooth(const recon::Posture& raw, double time_s, const SmoothingOptions& options,
                      SmoothingState& state);

}  // namespace ossa::tracker
