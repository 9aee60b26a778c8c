#pragma once
#include "tools/commands/track_options.h"

namespace ossa::commands {

/// `ossa track` with several recordings of the same people at the same time: each has a tracker and
/// a thread; the results are fused at the times of the first. options.tracker.models must be
/// loaded. On Ctrl-C or a failed recording the frames so far are fused and written, and the cause
/// is reported; if they cannot be fused, each camera's own skeletons are written: for --out
/// both.jsonl into both.cameras/NAME.jsonl. Throws UsageError for devices, InputError.
int TrackSeveral(const TrackOptions& options);

}  // namespace ossa::commands
