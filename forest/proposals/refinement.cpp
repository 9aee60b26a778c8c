// The second stage of recognition: a network of one hidden layer that knows how the first stage
// errs. It sees all modes, agreements and parts of an object at once (describe.cpp) and says of
// each target how far it lies from where the first stage puts it, and how sure that is. The idea of
// regressing from a first pose to a better one is that of Dollar et al. 2010 ("Cascaded pose
// regression") and of Toshev and Szegedy 2014; here one step is enough.
#include "forest/proposals/refinement_internal.h"

#include <algorithm>
#include <cmath>

namespace ossa::forest {

RowMatrix Normalised(const Refinement& refinement, std::span<const float> description) {
  constexpr float kFarthest = 5.0F;  // standard deviations
  RowMatrix row(1, static_cast<Eigen::Index>(description.size()));
  for (size_t i = 0; i < description.size(); ++i) {
    const float x = (description[i] - refinement.input_mean[i]) * refinement.input_scale[i];
    row(0, static_cast<Eigen::Index>(i)) = std::clamp(x, -kFarthest, kFarthest);
  }
  return row;
}

RowMatrix RunLayers(const Refinement& refinement, RowMatrix rows) {
  for (size_t l = 0; l < refinement.layers.size(); ++l) {
    const NetworkLayer& layer = refinement.layers[l];
    const auto outputs = static_cast<Eigen::Index>(layer.bias.size());
    const Eigen::Map<const RowMatrix> weight(layer.weight.data(), rows.cols(), outputs);
    const Eigen::Map<const Eigen::RowVectorXf> bias(layer.bias.data(), outputs);
    rows = Product(rows, weight);
    rows.rowwise() += bias;
    if (l + 1 < refinement.layers.size()) rows = rows.cwiseMax(0.0F);
  }
  return rows;
}

std::vector<RefinedPlace> Refine(const Refinement& refinement, const Description& description) {
  const RowMatrix out = RunLayers(refinement, Normalised(refinement, description.value));
  const auto targets = static_cast<Eigen::Index>(description.place_m.size());
  std::vector<RefinedPlace> places;
  for (Eigen::Index t = 0; t < targets; ++t) {
    const Eigen::Vector3d offset = out.block<1, 3>(0, 3 * t).transpose().cast<double>();
    places.push_back({description.place_m[static_cast<size_t>(t)] +
                          kRefinementStep_m * description.frame_from_camera.transpose() * offset,
                      1.0 / (1.0 + std::exp(-static_cast<double>(out(0, 3 * targets + t))))});
  }
  return places;
}

}  // namespace ossa::forest
