#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// The filters' distance metric. It is at least the difference of any single coordinate; the grid
/// relies on that. Returns early once it exceeds `limit`.
float FilterDistance(const float* a, const float* b, DatabaseFilter filter, float limit);

/// A spatial hash over four coordinates (hands and feet vary most) with a cell size equal to the
/// search radius: all postures within the radius lie in 3^4 cells.
class PostureGrid {
 public:
  PostureGrid(float radius_m, DatabaseFilter filter) : radius_m_(radius_m), filter_(filter) {}

  void Insert(const PostureVector& posture);
  bool AnyWithin(const PostureVector& posture) const;
  /// (distance, index) of every posture nearer than the radius, unsorted.
  std::vector<std::pair<float, int32_t>> Within(const PostureVector& posture) const;
  int size() const { return static_cast<int>(postures_.size()); }
  const PostureVector& posture(int i) const { return postures_[static_cast<size_t>(i)]; }

 private:
  using Cell = std::array<int, 4>;
  Cell CellOf(const PostureVector& posture) const;
  /// Calls visit(index) for the postures in the surrounding cells until it returns true.
  template <typename Visit>
  bool VisitAround(const PostureVector& posture, Visit visit) const;

  float radius_m_;
  DatabaseFilter filter_;
  std::vector<PostureVector> postures_;
  std::unordered_map<uint64_t, std::vector<int32_t>> cells_;
};

}  // namespace ossa::recon
