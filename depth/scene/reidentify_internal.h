#pragma once
#include <vector>

#include "depth/scene/scene.h"

// Who of those out of view somebody is who comes into view.
namespace ossa::depth {

/// Where somebody comes into view, or was last seen.
enum class Way {
  kOpen,    // in the middle of the room: mistaken for furniture until now, or through a door
  kBehind,  // at the outline of somebody nearer
  kBorder,  // at the image's left or right border
};

/// By what is around somebody's cells at their depths `z_m`. `person_of` says whose each cell is in
/// this frame (-1 nobody's), where somebody is `self`.
Way WayOf(const PointGrid& grid, const std::vector<int>& cells, const std::vector<float>& z_m,
          const std::vector<int>& person_of, int self);

/// Log of how much likelier it is that a newcomer is this lost user than that it is somebody new.
double LogLikelihoodRatio(const PointGrid& grid, const UserTrack& lost, const Candidate& newcomer,
                          Way way, double time_s, const ReidentifyOptions& options);

/// The assignment of columns to rows with the largest sum of weights; only positive weights count.
/// Column of each row, -1 for none. The Hungarian method.
std::vector<int> BestAssignment(const std::vector<std::vector<double>>& weight, size_t columns);

}  // namespace ossa::depth
