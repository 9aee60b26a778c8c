#pragma once
#include "recon/methods/prepared_posture_internal.h"

namespace ossa::recon {

/// What the last stages of `best` need to know of a frame, now and once more a frame later.
struct FrameState {
  Posture held;  // camera space: what is said of it should the next frame be told apart from it
  Placement placement;  // camera from normalised
  double scale = 1.0;   // of the person over the standard body
  double time_s = 0.0;
  JointWeights trust{}, reliability{};  // [0, 1]
};

}  // namespace ossa::recon
