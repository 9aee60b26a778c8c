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

/// Features of the classifier of people against other objects, of one frame; each about 0 to 1.
enum class PersonFeature {
  kCoherence,   // share of neighbouring samples with the same part; low on other objects
  kCertainty,   // mean probability of the most likely part, left or right
  kBody,        // mean probability of any part but `other`
  kHead,        // surface of the largest cluster of head samples, in units of 0.02 m2
  kOneHead,     // share of the head samples that belong to it
  kAbove,       // share of the surface more than 20 cm above it
  kSmall,       // whole surface, in units of 0.25 m2
  kLarge,       // surface above that of one person, 0.65 m2, in units of 0.5 m2
  kHeadShape,   // 1 if a head was detected by shape
  kTorsoBelow,  // how close the torso's centroid is to 45 cm from the head
  kFlat,        // share of flat surface; flatness is not measurable at a distance, hence kFar
  kFar,         // distance, in units of 6 m
  kCompact,     // how close samples are to the centroid of their part: 1 = within centimetres
  kNeighbours,  // of the borders between parts, the share between parts that are adjacent on a body
  kTrust,       // mean confidence of the best proposals of head, neck and trunk
  kAllTrust,    // the same of all 20 joints
  kBones,       // how close the bones between head, neck and trunk are to average lengths
  kCount
};
inline constexpr size_t kPersonFeatureCount = static_cast<size_t>(PersonFeature::kCount);
inline constexpr std::array<std::string_view, kPersonFeatureCount> kPersonFeatureNames = {
    "coherence", "certainty",  "body",       "head",        "one_head", "above",
    "small",     "large",      "head_shape", "torso_below", "flat",     "far",
    "compact",   "neighbours", "trust",      "all_trust",   "bones"};

/// The number of terms of a quadratic form of `features` variables: constant, linear, products.
constexpr size_t CountTerms(size_t features) {
  return 1 + features + features * (features + 1) / 2;
}

using PersonFeatures = std::array<double, kPersonFeatureCount>;

struct HeadCluster {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  double area_m2 = 0;
};

/// Clusters of pixels that the forest labels as head, largest first.
std::vector<HeadCluster> FindHeadClusters(const depth::DepthFrame& frame,
                                          const forest::Classification& seen);

/// Surface that the forest labels as legs and feet, m2.
double MeasureLegArea_m2(const depth::DepthFrame& frame, const forest::Classification& seen);

/// Sets the features that need no proposals.
void AddSurfaceFeatures(const depth::DepthFrame& frame, const Candidate& candidate,
                        const forest::Classification& seen, const std::vector<HeadCluster>& heads,
                        PersonFeatures& features);

/// Sets the features of the proposals.
void AddProposalFeatures(const std::vector<std::vector<forest::Proposal>>& proposals,
                         const recon::JointArray<int>& targets, PersonFeatures& features);

/// Probability of being a person, for a level camera or one under the ceiling: without and with the
/// features of the proposals.
double ComputeSurfaceScore(const PersonFeatures& features, bool from_above = false);
double ComputePersonScore(const PersonFeatures& features, bool from_above = false);

}  // namespace ossa::people
