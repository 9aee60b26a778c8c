#pragma once
#include "recon/skeleton_sequence.h"
#include "tools/commands/track_options.h"
#include "tools/tracker/skeleton_record.h"

namespace ossa::commands {

/// Tracked bodies as --posture and --mode request them for files.
class PostureRecorder {
 public:
  explicit PostureRecorder(const TrackOptions& options);
  recon::SkeletonFrame Record(const tracker::BodyFrame& bodies) const;

 private:
  bool seated_ = false;
  tracker::PostureKind kind_ = tracker::PostureKind::kFinal;
};

}  // namespace ossa::commands
