#pragma once
#include <vector>

#include "forest/training/images_internal.h"

namespace ossa::forest {

/// Numbers the leaves of a grown tree, breadth-first.
Tree NumberLeaves(const std::vector<Node>& nodes, int vote_depth);

/// Fills leaves with the joint distribution of context and class over all sampled pixels, and vote
/// rows with the targets' offsets. Sums are integers: independent of threads, parts and ranks.
void FillLeaves(const ImageParts& parts, const Reducer& reducer, size_t class_count,
                size_t context_count, size_t target_count, std::vector<Tree>* trees);

}  // namespace ossa::forest
