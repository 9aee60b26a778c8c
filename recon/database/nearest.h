#pragma once
#include <span>
#include <vector>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// Shum 2013 eq. 9: D(p_d, p_k) = sum over joints of R_i |p_d_i - p_k_i|^2, square metres.
double WeightedDistance(const PostureVector& a, const PostureVector& b,
                        const JointWeights& weights);

struct Neighbour {
  float distance = 0.0F;  // eq. 9
  int index = 0;
  auto operator<=>(const Neighbour&) const = default;
};

/// The k nearest postures under eq. 9, nearest first, exact. `hints` (the last frame's result) only
/// speed up the search: they bound the k-th distance, so that most postures are dropped after the
/// first few joints.
std::vector<Neighbour> NearestPostures(const PostureDatabase& database, const PostureVector& query,
                                       const JointWeights& weights, int k,
                                       std::span<const int> hints = {});

}  // namespace ossa::recon
