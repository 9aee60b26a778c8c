#pragma once
#include <span>
#include <string>
#include <vector>

#include "recon/motion/bvh.h"

namespace ossa::recon {

// The text of a BVH in parts, so that a long one need not be held whole.

/// All before the first frame's line.
std::string BvhHead(const std::vector<BvhJoint>& joints, double frame_s, size_t frames);
/// The line of a frame: its values in the order of the channels.
void AppendBvhFrame(std::string& text, std::span<const double> values);

}  // namespace ossa::recon
