#include <algorithm>
#include <cmath>

#include "recon/database/posture_grid_internal.h"

namespace ossa::recon {
namespace {

// The most independent coordinates of hands and feet: left hand x y, right hand y, left foot z.
constexpr std::array<int, 4> kAxes = {3 * 7, 3 * 7 + 1, 3 * 11 + 1, 3 * 15 + 2};

// Extremities first: they vary most, so large distances are detected early.
constexpr JointArray<int> kJointOrder = {11, 7,  15, 19, 10, 6, 14, 18, 9,  5,
                                         13, 17, 3,  8,  4,  2, 1,  12, 16, 0};

uint64_t Key(const std::array<int, 4>& cell) {
  uint64_t key = 0;
  for (const int c : cell) key = (key << 16) | static_cast<uint16_t>(c);
  return key;
}

}  // namespace

float FilterDistance(const float* a, const float* b, DatabaseFilter filter, float limit) {
  const float limit2 = limit * limit;
  float sum = 0.0F, largest = 0.0F;
  for (const int joint : kJointOrder) {
    const float dx = a[3 * joint] - b[3 * joint];
    const float dy = a[3 * joint + 1] - b[3 * joint + 1];
    const float dz = a[3 * joint + 2] - b[3 * joint + 2];
    const float d2 = dx * dx + dy * dy + dz * dz;
    sum += d2;
    largest = std::max(largest, d2);
    if ((filter == DatabaseFilter::kMaxJoint ? largest : sum) > limit2) return 2.0F * limit;
  }
  return std::sqrt(filter == DatabaseFilter::kMaxJoint ? largest : sum);
}

PostureGrid::Cell PostureGrid::CellOf(const PostureVector& posture) const {
  Cell cell;
  for (size_t k = 0; k < cell.size(); ++k) {
    cell[k] = static_cast<int>(std::floor(posture[kAxes[k]] / radius_m_));
  }
  return cell;
}

void PostureGrid::Insert(const PostureVector& posture) {
  cells_[Key(CellOf(posture))].push_back(static_cast<int32_t>(postures_.size()));
  postures_.push_back(posture);
}

template <typename Visit>
bool PostureGrid::VisitAround(const PostureVector& posture, Visit visit) const {
  const Cell centre = CellOf(posture);
  for (int n = 0; n < 81; ++n) {
    Cell cell = centre;
    for (int k = 0, rest = n; k < 4; ++k, rest /= 3) cell[static_cast<size_t>(k)] += rest % 3 - 1;
    const auto found = cells_.find(Key(cell));
    if (found == cells_.end()) continue;
    for (const int32_t i : found->second) {
      if (visit(i)) return true;
    }
  }
  return false;
}

bool PostureGrid::AnyWithin(const PostureVector& posture) const {
  return VisitAround(posture, [&](int32_t i) {
    const float* other = postures_[static_cast<size_t>(i)].data();
    return FilterDistance(posture.data(), other, filter_, radius_m_) <= radius_m_;
  });
}

std::vector<std::pair<float, int32_t>> PostureGrid::Within(const PostureVector& posture) const {
  std::vector<std::pair<float, int32_t>> found;
  VisitAround(posture, [&](int32_t i) {
    const float* other = postures_[static_cast<size_t>(i)].data();
    const float d = FilterDistance(posture.data(), other, filter_, radius_m_);
    if (d <= radius_m_) found.emplace_back(d, i);
    return false;
  });
  return found;
}

}  // namespace ossa::recon
