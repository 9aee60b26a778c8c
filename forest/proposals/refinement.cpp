// The second stage of recognition, cascaded pose regression of one stage (Dollar et al. 2010;
// Toshev and Szegedy 2014): a perceptron of one hidden layer that knows how the first stage errs.
// It reads all modes, marginals and parts of an object at once (joint_features.cpp) and says of
// each target how far it lies from where the first stage puts it, and how sure that is.
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
