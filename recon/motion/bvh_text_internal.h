#pragma once
#include <span>
#include <string>
#include <vector>

#include "recon/motion/bvh.h"

namespace ossa::recon {

// Writes the text of a BVH in parts, so that long files need not be held in memory.

/// The text before the first frame.
std::string BvhHead(const std::vector<BvhJoint>& joints, double frame_s, size_t frames);
/// Appends the line of a frame: its values in channel order.
void AppendBvhFrame(std::string& text, std::span<const double> values);

}  // namespace ossa::recon
