// Where each stage of the tracker puts the joints of one body.
#include "tools/experiments/real/real_evaluation_internal.h"

namespace ossa::tools {

StageJoints JointsAtStage(const tracker::Body& body, RealStage stage) {
  StageJoints joints;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool seen = body.raw.state[j] != recon::TrackingState::kNotTracked;
    if (stage == RealStage::kFinal) {
      joints[j] = body.joints[j].position_m;
    } else if (seen) {
      const bool refined = stage == RealStage::kRefined && body.refined;
      joints[j] = (refined ? *body.refined : body.raw.posture).position_m[j];
    }
    if (joints[j] && !joints[j]->allFinite()) joints[j].reset();
  }
  return joints;
}

}  // namespace ossa::tools
