#pragma once
#include <cstdint>
#include <vector>

#include "depth/image/depth_frame.h"
#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"

namespace ossa::forest {

/// Joint-conditioned relabelling: the likeliest class of each pixel given the target positions.
/// `proposals` are Propose's for this classification. Labels are unchanged if the model has no
/// relabelling. The same labels on every machine.
std::vector<uint8_t> Relabel(const ForestModel& model, const depth::DepthView& depth,
                             const depth::Camera& camera, const Classification& classification,
                             const std::vector<std::vector<Proposal>>& proposals);

}  // namespace ossa::forest
