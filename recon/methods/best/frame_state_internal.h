#pragma once
#include "recon/methods/prepared_posture_internal.h"

namespace ossa::recon {

/// State of a frame for the last stages of `best`, for the estimate now and the revised one a frame
/// later.
struct FrameState {
  Posture held;         // camera space: its revised estimate if the next frame is unrelated
  Placement placement;  // camera from normalised
  double scale = 1.0;   // size relative to the standard body
  double time_s = 0.0;
  JointWeights trust{}, reliability{};  // [0, 1]
};

}  // namespace ossa::recon
