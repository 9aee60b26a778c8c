#pragma once
#include <vector>

#include "tools/people/body_measures.h"
#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

// Who of the lost somebody is who comes into view.
namespace ossa::people {

/// Where somebody comes into view, or was last seen.
enum class Entrance {
  kOpen,    // in the middle of the room: mistaken for furniture until now, or through a door
  kBehind,  // at the silhouette of somebody nearer
  kBorder,  // at the image's left or right border
};

/// By what is around somebody's cells at their depths `z_m`. `person_of` says whose each cell is in
/// this frame (-1 nobody's), where somebody is `self`.
Entrance FindEntrance(const PointGrid& grid, const std::vector<int>& cells,
                      const std::vector<float>& z_m, const std::vector<int>& person_of, int self,
                      const ReidentifyOptions& options = {});

/// Log of how much likelier it is that somebody new, seen at `place_m` (camera space, metres), is
/// this lost track than that it is somebody else.
double CompareWithLost(const PointGrid& grid, const Track& lost, const Eigen::Vector3f& place_m,
                       const FrameMeasures& measures, Entrance entrance, double time_s,
                       const ReidentifyOptions& options);

/// The assignment of columns to rows with the largest sum of weights; only positive weights count.
/// Column of each row, -1 for none. The Hungarian method.
std::vector<int> FindBestAssignment(const std::vector<std::vector<double>>& weight, size_t columns);

}  // namespace ossa::people
