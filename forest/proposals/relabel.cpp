// Shotton et al. 2011 label each pixel by the depths around it, and joints follow from the labels.
// Departure: the joints, which depend on the whole object, in turn correct the labels:
//   P(c | pixel) ∝ (P_trees(c | pixel) + small) · exp(score_c(x)),
//   score_c(x) = b_c + Σ_t Σ_s (w_cts + confidence_t · v_cts) · N_s(|x - x_t|),
// with x the pixel's surface point, x_t the position proposed for target t, and N_s three radial
// basis functions, from narrow to wide. It is multinomial logistic regression with the trees'
// log-probabilities as an offset; b, w, v are learned on images that the trees have not seen.
#include "forest/proposals/relabel.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "depth/base/cpu_dispatch.h"
#include "forest/forest.h"
#include "forest/proposals/relabel_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand; part of every shipped model.

constexpr float kReach_m = 0.4F;  // distance at which the widest radial basis has fallen to a half
// Scores are smooth: pixels of one surface within this distance share them.
constexpr double kSpot_m = 0.04;
constexpr int kSameSurface_mm = 60;
constexpr int kMostSpot_px = 16;

// Positions at which scores are evaluated.
struct Spots {
  std::vector<Eigen::Vector3f> point_m;
  std::vector<uint32_t> of_pixel;  // spot of each of the classification's pixels
};

int SpotSize_px(const depth::DepthView& depth, const depth::Camera& camera,
                const std::vector<int32_t>& pixels) {
  constexpr size_t kSamples = 256;  // sufficient for the mean depth
  const size_t step = std::max<size_t>(1, pixels.size() / kSamples);
  int64_t sum_mm = 0;
  int64_t samples = 0;
  for (size_t i = 0; i < pixels.size(); i += step, ++samples) {
    sum_mm += depth.at(pixels[i] % depth.width, pixels[i] / depth.width);
  }
  const double mean_m = 1e-3 * static_cast<double>(sum_mm) / static_cast<double>(samples);
  return std::clamp(static_cast<int>(kSpot_m * camera.fx / mean_m), 1, kMostSpot_px);
}

// One spot per image square; one per surface if a square shows two.
Spots ChooseSpots(const depth::DepthView& depth, const depth::Camera& camera,
                  const std::vector<int32_t>& pixels) {
  struct Last {  // current spot of a square
    uint32_t spot = 0;
    int row = -1;
    int depth_mm = 0;
  };
  const int size = SpotSize_px(depth, camera, pixels);
  const double centre = 0.5 * (size - 1);
  std::vector<int> square_of(static_cast<size_t>(depth.width));
  for (int u = 0; u < depth.width; ++u) square_of[static_cast<size_t>(u)] = u / size;
  std::vector<Last> last(static_cast<size_t>(depth.width / size + 1));
  Spots spots;
  spots.of_pixel.reserve(pixels.size());
  int v = 0;
  for (const int32_t pixel : pixels) {
    while (pixel >= (v + 1) * depth.width) ++v;  // pixels are ascending: avoids a division
    const int u = pixel - v * depth.width;
    const int mm = depth.at(u, v);
    Last& here = last[static_cast<size_t>(square_of[static_cast<size_t>(u)])];
    const int since = v - here.row;  // first row of the square
    if (here.row < 0 || since >= size || std::abs(mm - here.depth_mm) > kSameSurface_mm) {
      const int row = v - v % size;
      here = {static_cast<uint32_t>(spots.point_m.size()), row, mm};
      const double u_px = square_of[static_cast<size_t>(u)] * size + centre;
      spots.point_m.push_back(depth::BackProject(camera, u_px, row + centre, mm).cast<float>());
    }
    spots.of_pixel.push_back(here.spot);
  }
  return spots;
}

OSSA_CPU_DISPATCH void EvaluateRadialBasis(const Anchors& anchors, const Eigen::Vector3f& point_m,
                                           float* out) {
  constexpr float kPerSquare = 1.0F / (kReach_m * kReach_m);  // per square metre, no unit
  const size_t targets = anchors.x.size();
  const float px = point_m.x(), py = point_m.y(), pz = point_m.z();
  for (size_t t = 0; t < targets; ++t) {
    const float x = px - anchors.x[t];
    const float y = py - anchors.y[t];
    const float z = pz - anchors.z[t];
    const float slow = 1.0F / (1.0F + (x * x + y * y + z * z) * kPerSquare);
    const float middle = (slow * slow) * (slow * slow);
    out[t] = slow;
    out[targets + t] = middle;
    out[2 * targets + t] = (middle * middle) * (middle * middle);
  }
}

// 2^x for x <= 0, accurate to a thousandth; library versions differ between machines.
inline float Exp2(float x) {
  constexpr int kLeastExponent = -60;
  const int below = static_cast<int>(x) - 1;
  const float f = x - static_cast<float>(below);  // in (0, 1]
  const float fraction = 1.0F + f * (0.6958F + f * (0.2250F + f * 0.0792F));
  const int exponent = below > kLeastExponent ? below : kLeastExponent;
  return fraction * std::bit_cast<float>((exponent + 127) << 23);
}

// exp(score - largest score), in place; scores are base-2 logarithms.
OSSA_CPU_DISPATCH void ToFactors(float* score, size_t count) {
  float most = score[0];
  for (size_t c = 1; c < count; ++c) most = score[c] > most ? score[c] : most;
  for (size_t c = 0; c < count; ++c) score[c] = Exp2(score[c] - most);
}

// Score weights for these anchors: basis function × class.
RowMatrix ComputeWeights(const Relabelling& prior, const Anchors& anchors, Eigen::Index classes) {
  const auto targets = static_cast<Eigen::Index>(anchors.x.size());
  const Eigen::Index rows = targets * static_cast<Eigen::Index>(kRadialBasisScales);
  const Eigen::Map<const RowMatrix> given(prior.weight.data(), 2 * rows, classes);
  RowMatrix weight = given.topRows(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    weight.row(i) += anchors.confidence[static_cast<size_t>(i % targets)] * given.row(rows + i);
  }
  return weight;
}

// Spot × stride: factors of the trees' probabilities; 0 in padding columns.
RowMatrix ComputeFactors(const Relabelling& prior, const Anchors& anchors, const Spots& spots,
                         Eigen::Index stride) {
  constexpr float kLog2OfE = 1.44269504F;  // no unit; by definition
  const auto classes = static_cast<Eigen::Index>(prior.bias.size());
  RowMatrix weight =
      RowMatrix::Zero(static_cast<Eigen::Index>(anchors.x.size() * kRadialBasisScales), stride);
  weight.leftCols(classes) = kLog2OfE * ComputeWeights(prior, anchors, classes);
  RowMatrix factor = Multiply(ComputeRadialBasis(anchors, spots.point_m), weight);
  factor.leftCols(classes).rowwise() +=
      kLog2OfE * Eigen::Map<const Eigen::RowVectorXf>(prior.bias.data(), classes);
  for (Eigen::Index i = 0; i < factor.rows(); ++i) {
    ToFactors(factor.row(i).data(), static_cast<size_t>(classes));
  }
  factor.rightCols(stride - classes).setZero();
  return factor;
}

// Column of the largest product; the first of equals. Bits of positive floats sort like their
// values: the last eight bits carry the column.
OSSA_CPU_DISPATCH uint8_t Likeliest(const uint16_t* mass, float scale, const float* factor,
                                    size_t columns) {
  constexpr int32_t kColumnBits = 0xff;
  int32_t best = 0;
  for (size_t c = 0; c < columns; ++c) {
    const float p = (static_cast<float>(mass[c]) * scale + kLeastLeafProbability) * factor[c];
    const int32_t key =
        (std::bit_cast<int32_t>(p) & ~kColumnBits) | (kColumnBits - static_cast<int32_t>(c));
    best = key > best ? key : best;
  }
  return static_cast<uint8_t>(kColumnBits - (best & kColumnBits));
}

}  // namespace

Anchors::Anchors(const std::vector<std::vector<Proposal>>& proposals) {
  constexpr float kNowhere_m = 1e4F;
  for (const std::vector<Proposal>& list : proposals) {
    const Eigen::Vector3f place_m = list.empty()
                                        ? Eigen::Vector3f::Constant(kNowhere_m)
                                        : Eigen::Vector3f(list[0].position_m.cast<float>());
    x.push_back(place_m.x());
    y.push_back(place_m.y());
    z.push_back(place_m.z());
    confidence.push_back(list.empty() ? 0.0F : static_cast<float>(list[0].confidence));
  }
}

RowMatrix ComputeRadialBasis(const Anchors& anchors, const std::vector<Eigen::Vector3f>& points_m) {
  RowMatrix near(static_cast<Eigen::Index>(points_m.size()),
                 static_cast<Eigen::Index>(anchors.x.size() * kRadialBasisScales));
  for (size_t i = 0; i < points_m.size(); ++i) {
    EvaluateRadialBasis(anchors, points_m[i], near.row(static_cast<Eigen::Index>(i)).data());
  }
  return near;
}

std::vector<uint8_t> Relabel(const ForestModel& model, const depth::DepthView& depth,
                             const depth::Camera& camera, const Classification& classification,
                             const std::vector<std::vector<Proposal>>& proposals) {
  const Relabelling& prior = model.data().relabelling;
  std::vector<uint8_t> label = classification.label;
  if (prior.bias.empty() || label.empty()) return label;
  const Anchors anchors(proposals);
  const Spots spots = ChooseSpots(depth, camera, classification.pixel);
  const size_t stride = classification.mass_stride;
  const RowMatrix factor = ComputeFactors(prior, anchors, spots, static_cast<Eigen::Index>(stride));
  // Pixels with the same sample and spot have the same label: cache the last one per sample.
  struct Last {
    uint32_t spot = ~0U;
    uint8_t label = 0;
  };
  std::vector<Last> last(classification.mass_scale.size());
  for (size_t i = 0; i < label.size(); ++i) {
    if (label[i] == 0) continue;  // unlabelled by the trees
    const auto sample = static_cast<size_t>(classification.sample[i]);
    const uint32_t spot = spots.of_pixel[i];
    if (last[sample].spot != spot) {
      const uint8_t column =
          Likeliest(classification.mass.data() + sample * stride, classification.mass_scale[sample],
                    factor.row(spot).data(), stride);
      last[sample] = {spot, static_cast<uint8_t>(column + 1)};
    }
    label[i] = last[sample].label;
  }
  return label;
}

}  // namespace ossa::forest
