#pragma once
#include <cstdint>
#include <vector>

#include "tools/synth/dataset.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

/// Adds what is true of a frame beside its labels: skeletons, which of their joints are seen, floor
/// and time.
void AddTruth(std::vector<TruthBody> bodies, const ViewSample& view, int64_t index,
              LabelledFrame* frame);

/// Whether enough of the first person is seen for the frame to be worth anything.
bool ShowsEnough(const LabelledFrame& frame, const FrameOptions& options);

}  // namespace ossa::tools
