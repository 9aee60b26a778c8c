#pragma once
#include <vector>

#include "tools/people/body_measures.h"
#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

// Re-identification: assigns people who appear to lost tracks.
namespace ossa::people {

/// Place where a person appears, or was last seen.
enum class Entrance {
  kOpen,    // in the middle of the image: through a door, or rejected until now
  kBehind,  // at the silhouette of a nearer person
  kBorder,  // at the image's left or right border
};

/// The entrance by the surroundings of a person's cells at depths `z_m`. `person_of`: the person
/// that each cell belongs to in this frame (-1 for none); `self` is this person.
Entrance FindEntrance(const PointGrid& grid, const std::vector<int>& cells,
                      const std::vector<float>& z_m, const std::vector<int>& person_of, int self,
                      const ReidentifyOptions& options = {});

/// Log-odds of a person at `place_m` (camera space, metres) being this lost track against being
/// another person.
double ComputeLostTrackLogOdds(const PointGrid& grid, const Track& lost,
                               const Eigen::Vector3f& place_m, const FrameMeasures& measures,
                               Entrance entrance, double time_s, const ReidentifyOptions& options);

/// The assignment of columns to rows with the largest sum of weights; pairs with weight <= 0 are
/// never assigned. Returns the column of each row, -1 for none. The Hungarian method.
std::vector<int> FindBestAssignment(const std::vector<std::vector<double>>& weight, size_t columns);

}  // namespace ossa::people
