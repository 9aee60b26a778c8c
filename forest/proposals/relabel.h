#pragma once
#include <cstdint>
#include <vector>

#include "depth/image/depth_frame.h"
#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"

namespace ossa::forest {

/// Joint-conditioned relabelling: the likeliest class of each of the classification's pixels once
/// it is known where the targets are. `proposals` are Propose's for this classification. Labels as
/// they were where the model learned none. The same labels on every machine.
std::vector<uint8_t> Relabel(const ForestModel& model, const depth::DepthView& depth,
                             const depth::Camera& camera, const Classification& classification,
                             const std::vector<std::vector<Proposal>>& proposals);

}  // namespace ossa::forest
