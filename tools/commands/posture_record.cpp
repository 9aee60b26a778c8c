#include "tools/commands/posture_record.h"

namespace ossa::commands {

PostureRecorder::PostureRecorder(const TrackOptions& options)
    : seated_(options.mode == "seated"), kind_(tracker::ParsePostureKind(options.posture)) {}

recon::SkeletonFrame PostureRecorder::Record(const tracker::BodyFrame& bodies) const {
  recon::SkeletonFrame record = tracker::ToRecord(bodies, kind_);
  if (seated_) tracker::KeepSeatedJoints(record);
  return record;
}

}  // namespace ossa::commands
