#pragma once
#include <cstdint>
#include <vector>

#include "forest/forest.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Depth, true parts and the parts of the model side by side, as a PNG of three times the
/// frame's width. The frame has its data set's size (Uncropped).
std::vector<uint8_t> DrawPanels(const forest::ForestModel& model, const LabelledFrame& frame);

}  // namespace ossa::tools
