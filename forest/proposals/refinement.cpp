// The second stage of recognition, a single stage of cascaded pose regression (Dollar et al. 2010;
// Toshev and Szegedy 2014): a perceptron with one hidden layer that corrects the errors of the
// first stage. From all modes, marginals and parts of an object (joint_features.cpp) it predicts
// each target's offset from the first stage's position, and its confidence.
#include "forest/proposals/refinement_internal.h"

#include <cmath>
#include <numeric>

namespace ossa::forest {

std::vector<RefinedPlace> Refine(const RoundedPerceptron& refinement,
                                 const JointFeatures& features) {
  std::vector<Eigen::Vector3d> places_m = features.place_m;
  std::vector<size_t> targets(places_m.size());
  std::iota(targets.begin(), targets.end(), size_t{0});
  const RegressedPoints all{targets};
  const RowMatrix out = Regress(refinement, features.value, std::span(&all, 1), features.frame,
                                OffsetScale(), places_m);
  std::vector<RefinedPlace> refined;
  for (const size_t t : targets) {
    const double logit = out(0, static_cast<Eigen::Index>(3 * targets.size() + t));
    refined.push_back({places_m[t], 1.0 / (1.0 + std::exp(-logit))});
  }
  return refined;
}

}  // namespace ossa::forest
