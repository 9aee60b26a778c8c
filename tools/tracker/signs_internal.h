#pragma once
#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "depth/scene/scene.h"
#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "recon/skeleton.h"

namespace ossa::tracker {

/// What a first look tells a person from a piece of furniture by; each about 0 to 1.
enum class Sign {
  kCoherence,   // share of neighbouring samples with the same part: noise on what is no body
  kCertainty,   // mean probability of the best part, left or right
  kBody,        // mean probability of any part but `other`
  kHead,        // surface of the largest cluster of head samples, of 0.02 m2
  kOneHead,     // share of the head samples that lie in it
  kAbove,       // share of the surface more than 20 cm above it
  kSmall,       // all surface, of 0.25 m2
  kLarge,       // surface beyond what one person has, 0.65 m2, of 0.5 m2
  kHeadShape,   // 1 when the scene sees something like a head on shoulders
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
inline constexpr size_t kSignCount = static_cast<size_t>(Sign::kCount);
inline constexpr std::array<std::string_view, kSignCount> kSignNames = {
    "coherence", "certainty",  "body",       "head",        "one_head", "above",
    "small",     "large",      "head_shape", "torso_below", "flat",     "far",
    "compact",   "neighbours", "trust",      "all_trust",   "bones"};

/// Terms of a quadratic form of so many signs: constant, linear, products.
constexpr size_t TermsOf(size_t signs) { return 1 + signs + signs * (signs + 1) / 2; }

using Signs = std::array<double, kSignCount>;

struct Head {
  Eigen::Vector3d mean_m;
  double area_m2 = 0;
};

/// Clusters of head samples, largest first.
std::vector<Head> FindHeadClusters(const depth::DepthFrame& frame,
                                   const forest::Classification& seen);

/// Surface that looks like legs and feet, square metres.
double LegArea(const depth::DepthFrame& frame, const forest::Classification& seen);

/// Signs that need no proposals.
void LookAtSurface(const depth::DepthFrame& frame, const depth::Candidate& candidate,
                   const forest::Classification& seen, const std::vector<Head>& heads, Signs& sign);

/// The others.
void LookAtProposals(const std::vector<std::vector<forest::Proposal>>& proposals,
                     const recon::JointArray<int>& targets, Signs& sign);

/// Probability that it is a person: before, and after proposals were made.
double SurfaceScore(const Signs& sign);
double PersonScore(const Signs& sign);

}  // namespace ossa::tracker
