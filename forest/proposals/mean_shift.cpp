#include "depth/base/cpu_dispatch.h"
#include "depth/base/lanes.h"
#include "forest/proposals/modes_internal.h"

// All CPU variants sum in the same eight lanes without fused multiply-add, so that every machine
// gives the same bits.
namespace ossa::forest {
namespace {

struct LaneSums {
  Lanes density = {};
  Lanes x = {};
  Lanes y = {};
  Lanes z = {};
};

// Departure: the Gaussian exp(-r²/2b²) is approximated by (1 - r²/(16 b²))^8, within 0.03, which is
// zero beyond 4 b and needs no exponential.
template <bool kMoment>
[[gnu::always_inline]] inline void Accumulate(const WeightedPoints& points, const float* at,
                                              float inverse, LaneSums* out) {
  LaneSums sums;
  for (size_t i = 0; i < points.size(); i += kLanes) {
    Lanes px, py, pz, weight;
    LoadLanes(points.x_m.data() + i, &px);
    LoadLanes(points.y_m.data() + i, &py);
    LoadLanes(points.z_m.data() + i, &pz);
    LoadLanes(points.weight.data() + i, &weight);
    const Lanes dx = px - at[0];
    const Lanes dy = py - at[1];
    const Lanes dz = pz - at[2];
    Lanes k = 1.0F - (dx * dx + dy * dy + dz * dz) * inverse;
    k = k > 0.0F ? k : Lanes{};
    k *= k;
    k *= k;
    k *= k * weight;
    sums.density += k;
    if constexpr (!kMoment) continue;
    sums.x += k * px;
    sums.y += k * py;
    sums.z += k * pz;
  }
  *out = sums;
}

OSSA_CPU_DISPATCH void AccumulateDensity(const WeightedPoints& points, const float* at,
                                         float inverse, LaneSums* out) {
  Accumulate<false>(points, at, inverse, out);
}

OSSA_CPU_DISPATCH void AccumulateAll(const WeightedPoints& points, const float* at, float inverse,
                                     LaneSums* out) {
  Accumulate<true>(points, at, inverse, out);
}

float Inverse(float bandwidth_m) { return 1.0F / (16.0F * bandwidth_m * bandwidth_m); }

float Sum(const Lanes& lane) {
  float total = 0.0F;
  for (size_t l = 0; l < kLanes; ++l) total += lane[l];
  return total;
}

}  // namespace

KernelSum SumKernels(const WeightedPoints& points, const Eigen::Vector3f& at_m, float bandwidth_m) {
  LaneSums sums;
  AccumulateAll(points, at_m.data(), Inverse(bandwidth_m), &sums);
  return {Sum(sums.density), {Sum(sums.x), Sum(sums.y), Sum(sums.z)}};
}

float Density(const WeightedPoints& points, const Eigen::Vector3f& at_m, float bandwidth_m) {
  LaneSums sums;
  AccumulateDensity(points, at_m.data(), Inverse(bandwidth_m), &sums);
  return Sum(sums.density);
}

}  // namespace ossa::forest
