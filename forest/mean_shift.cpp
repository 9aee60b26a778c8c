#include <bit>
#include <cstring>

#include "forest/clones_internal.h"
#include "forest/propose_internal.h"

// Every clone adds in the same eight lanes, and none may contract a product and a sum, so that each
// machine gives the same bits.
namespace ossa::forest {
namespace {

constexpr size_t kLanes = 8;

using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

struct LaneSums {
  Lanes density = {};
  Lanes x = {};
  Lanes y = {};
  Lanes z = {};
};

// Departure: the Gaussian exp(-r²/2b²) is taken as (1 - r²/(16 b²))^8, which is within 0.03 of it,
// is zero beyond 4 b, and needs no exponential.
OSSA_CLONES void Accumulate(const float* x, const float* y, const float* z, const float* w,
                            size_t blocks, const float* at, float inverse, LaneSums* out) {
  LaneSums sums = *out;
  for (size_t i = 0; i < blocks * kLanes; i += kLanes) {
    Lanes px, py, pz, weight;
    std::memcpy(&px, x + i, sizeof(Lanes));
    std::memcpy(&py, y + i, sizeof(Lanes));
    std::memcpy(&pz, z + i, sizeof(Lanes));
    std::memcpy(&weight, w + i, sizeof(Lanes));
    const Lanes dx = px - at[0];
    const Lanes dy = py - at[1];
    const Lanes dz = pz - at[2];
    Lanes k = 1.0F - (dx * dx + dy * dy + dz * dz) * inverse;
    k = k > 0.0F ? k : Lanes{};
    k *= k;
    k *= k;
    k *= k * weight;
    sums.density += k;
    sums.x += k * px;
    sums.y += k * py;
    sums.z += k * pz;
  }
  *out = sums;
}

float Sum(const Lanes& lane) {
  float total = 0.0F;
  for (size_t l = 0; l < kLanes; ++l) total += lane[l];
  return total;
}

}  // namespace

KernelSum SumKernels(const WeightedPoints& points, const Eigen::Vector3f& at_m, float bandwidth_m) {
  const float inverse = 1.0F / (16.0F * bandwidth_m * bandwidth_m);
  LaneSums sums;
  const size_t blocks = points.size() / kLanes;
  Accumulate(points.x.data(), points.y.data(), points.z.data(), points.weight.data(), blocks,
             at_m.data(), inverse, &sums);
  const size_t done = blocks * kLanes;
  if (done < points.size()) {  // the rest, padded with weightless points
    float rest[4][kLanes] = {};
    for (size_t i = done; i < points.size(); ++i) {
      rest[0][i - done] = points.x[i];
      rest[1][i - done] = points.y[i];
      rest[2][i - done] = points.z[i];
      rest[3][i - done] = points.weight[i];
    }
    Accumulate(rest[0], rest[1], rest[2], rest[3], 1, at_m.data(), inverse, &sums);
  }
  return {Sum(sums.density), {Sum(sums.x), Sum(sums.y), Sum(sums.z)}};
}

}  // namespace ossa::forest
