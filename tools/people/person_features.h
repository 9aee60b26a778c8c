#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "recon/skeleton.h"
#include "tools/people/candidate.h"

namespace ossa::people {

/// What tells a person from a piece of furniture in one frame; each about 0 to 1.
enum class PersonFeature {
  kCoherence,   // share of neighbouring samples with the same part: noise on what is no body
  kCertainty,   // mean probability of the best part, left or right
  kBody,        // mean probability of any part but `other`
  kHead,        // surface of the largest cluster of head samples, of 0.02 m2
  kOneHead,     // share of the head samples that lie in it
  kAbove,       // share of the surface more than 20 cm above it
  kSmall,       // all surface, of 0.25 m2
  kLarge,       // surface beyond what one person has, 0.65 m2, of 0.5 m2
  kHeadShape,   // 1 when its shape has something like a head on shoulders
  kTorsoBelow,  // how well the torso's middle lies 45 cm off the head
  kFlat,        // share of it that is flat; far away the sensor cannot tell, hence ...
  kFar,         // ... its distance, of 6 m
  kCompact,     // how near samples lie to the middle of their part: 1 = within centimetres
  kNeighbours,  // of the borders between parts, the share between parts that meet on a body
  kTrust,       // mean confidence of the best proposals of head, neck and trunk
  kAllTrust,    // of all 20 joints
  kBones,       // how well the bones between the former have a body's lengths
  kCount
};
inline constexpr size_t kPersonFeatureCount = static_cast<size_t>(PersonFeature::kCount);
inline constexpr std::array<std::string_view, kPersonFeatureCount> kPersonFeatureNames = {
    "coherence", "certainty",  "body",       "head",        "one_head", "above",
    "small",     "large",      "head_shape", "torso_below", "flat",     "far",
    "compact",   "neighbours", "trust",      "all_trust",   "bones"};

/// Terms of a quadratic form of so many features: constant, linear, products.
constexpr size_t CountTerms(size_t features) {
  return 1 + features + features * (features + 1) / 2;
}

using PersonFeatures = std::array<double, kPersonFeatureCount>;

struct HeadCluster {
  Eigen::Vector3d mean_m;
  double area_m2 = 0;
};

/// Clusters of pixels that the forest labels as head, largest first.
std::vector<HeadCluster> FindHeadClusters(const depth::DepthFrame& frame,
                                          const forest::Classification& seen);

/// Surface that the forest labels as legs and feet, square metres.
double MeasureLegArea_m2(const depth::DepthFrame& frame, const forest::Classification& seen);

/// Adds the features that need no proposals.
void AddSurfaceFeatures(const depth::DepthFrame& frame, const Candidate& candidate,
                        const forest::Classification& seen, const std::vector<HeadCluster>& heads,
                        PersonFeatures& features);

/// Adds the others.
void AddProposalFeatures(const std::vector<std::vector<forest::Proposal>>& proposals,
                         const recon::JointArray<int>& targets, PersonFeatures& features);

/// Probability that it is a person, as a level camera sees it or one under the ceiling: before, and
/// after proposals were made.
double ComputeSurfaceScore(const PersonFeatures& features, bool from_above = false);
double ComputePersonScore(const PersonFeatures& features, bool from_above = false);

}  // namespace ossa::people
