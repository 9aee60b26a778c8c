#pragma once
#include "tools/commands/track_options.h"

namespace ossa::commands {

/// `ossa track` of several recordings of the same people at the same time: each by a tracker and a
/// thread of its own, then fused at the first one's times. options.tracker.models are loaded. What
/// was tracked until Ctrl-C, or until a recording failed, is fused and written, then said; where it
/// cannot be fused, each camera's own skeletons are written: of --out both.jsonl into
/// both.cameras/NAME.jsonl. Throws UsageError for devices, InputError.
int TrackSeveral(const TrackOptions& options);

}  // namespace ossa::commands
