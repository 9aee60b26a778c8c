#include "tools/commands/posture_record.h"

namespace ossa::commands {
namespace {

// Nobody looks for the others.
void KeepSeatedJoints(recon::SkeletonFrame& record) {
  for (recon::BodyRecord& body : record.bodies) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!tracker::IsSeatedJoint(static_cast<recon::Joint>(j))) body.joints[j].reset();
    }
  }
}

}  // namespace

PostureRecorder::PostureRecorder(const TrackOptions& options) : seated_(options.mode == "seated") {
  const std::string& posture = options.posture;
  if (posture == "raw") kind_ = tracker::PostureKind::kRaw;
  if (posture == "refined") kind_ = tracker::PostureKind::kRefined;
  if (posture == "fitted") kind_ = tracker::PostureKind::kFitted;
  if (posture == "reconstructed") kind_ = tracker::PostureKind::kReconstructed;
}

recon::SkeletonFrame PostureRecorder::Record(const tracker::BodyFrame& bodies) const {
  recon::SkeletonFrame record = tracker::ToRecord(bodies, kind_);
  if (seated_) KeepSeatedJoints(record);
  return record;
}

}  // namespace ossa::commands
