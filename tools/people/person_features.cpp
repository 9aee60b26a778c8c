#include "tools/people/person_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "recon/body/parts.h"
#include "recon/body/standard_body.h"

namespace ossa::people {
namespace {

using Eigen::Vector3d;
using forest::Classification;

// Labels, by the convention of recon/body/parts.h.
constexpr int kLastHeadLabel = 4;
constexpr int kFirstTorsoLabel = 18, kLastTorsoLabel = 21;

// Logistic regressions of "is a person" over the features and their products, written by `ossa
// experiment person-classifier`: kSurfaceWeights, kPersonWeights and, for a camera under the
// ceiling, the same FromAbove.
#include "tools/people/person_classifier_weights.inc"
#include "tools/people/person_classifier_weights_from_above.inc"

struct Cluster {
  Vector3d sum = Vector3d::Zero();
  double area_m2 = 0;
  int count = 0;
  Vector3d mean() const { return sum / count; }
};

struct Sample {
  Vector3d position_m;
  double area_m2 = 0;
};

Sample BackProjectSample(const depth::DepthFrame& frame, int32_t pixel) {
  const depth::Camera& camera = frame.camera;
  const Vector3d p = depth::BackProject(camera, pixel % camera.width, pixel / camera.width,
                                        frame.view().at(pixel));
  return {p, p.z() * p.z() / (camera.fx * camera.fy)};
}

std::vector<Cluster> CollectHeadClusters(const depth::DepthFrame& frame,
                                         const Classification& seen) {
  constexpr double kHeadSize_m = 0.17;  // anthropometry: across a face
  std::vector<Cluster> clusters;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    if (seen.label[i] < 1 || seen.label[i] > kLastHeadLabel) continue;
    const Sample at = BackProjectSample(frame, seen.pixel[i]);
    auto near = std::find_if(clusters.begin(), clusters.end(), [&](const Cluster& cluster) {
      return (cluster.mean() - at.position_m).norm() < kHeadSize_m;
    });
    if (near == clusters.end()) near = clusters.insert(clusters.end(), Cluster{});
    near->sum += at.position_m;
    near->area_m2 += at.area_m2;
    ++near->count;
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.area_m2 > b.area_m2; });
  return clusters;
}

// Backs are easily classified as fronts, with left and right exchanged; for detection this does not
// matter.
uint8_t FoldSides(uint8_t label) { return std::min(label, recon::kMirroredPart[label]); }

// The share of neighbouring samples that have the same label.
double MeasureCoherence(const Classification& seen, int width) {
  size_t pairs = 0, same = 0, above = 0;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    if (i > 0 && seen.pixel[i] == seen.pixel[i - 1] + 1) {
      ++pairs;
      same += FoldSides(seen.label[i]) == FoldSides(seen.label[i - 1]) ? 1 : 0;
    }
    while (seen.pixel[above] < seen.pixel[i] - width) ++above;
    if (seen.pixel[above] == seen.pixel[i] - width) {
      ++pairs;
      same += FoldSides(seen.label[i]) == FoldSides(seen.label[above]) ? 1 : 0;
    }
  }
  return pairs == 0 ? 0.0 : static_cast<double>(same) / static_cast<double>(pairs);
}

// Parts are compact on a body and scattered on other objects: mean over the samples of exp(-(d / 15
// cm)^2), d the distance from the centroid of all samples with the same label.
double MeasureCompactness(const depth::DepthFrame& frame, const Classification& seen) {
  std::array<Cluster, recon::kLabelCount> parts;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    Cluster& part = parts[seen.label[i]];
    part.sum += BackProjectSample(frame, seen.pixel[i]).position_m;
    ++part.count;
  }
  double near = 0;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    const Vector3d middle = parts[seen.label[i]].mean();
    near += std::exp(-(BackProjectSample(frame, seen.pixel[i]).position_m - middle).squaredNorm() /
                     0.0225);
  }
  return seen.pixel.empty() ? 0.0 : near / static_cast<double>(seen.pixel.size());
}

// Whether two parts are adjacent on a body; left ones stand for both sides (labels of parts.h).
bool AreAdjacentParts(uint8_t a, uint8_t b) {
  constexpr std::array<std::array<uint8_t, 2>, 20> kPairs = {
      {{1, 3},   {1, 5},   {3, 5},   {3, 6},   {5, 6},   {5, 18},  {6, 8},
       {6, 18},  {8, 18},  {8, 12},  {10, 12}, {10, 14}, {14, 16}, {18, 20},
       {20, 22}, {22, 26}, {24, 26}, {24, 28}, {28, 30}, {8, 20}}};
  const std::array<uint8_t, 2> pair = {std::min(a, b), std::max(a, b)};
  return std::find(kPairs.begin(), kPairs.end(), pair) != kPairs.end();
}

// Only borders within one surface count: in the image a hand in front of the chest borders on any
// part.
double MeasureNeighbourShare(const depth::DepthFrame& frame, const Classification& seen) {
  constexpr int kOneSurface_mm = 60;  // by hand; part of the classifier, which was learned with it
  const depth::DepthView view = frame.view();
  double borders = 0, meeting = 0;
  for (size_t i = 1; i < seen.pixel.size(); ++i) {
    const uint8_t a = FoldSides(seen.label[i]), b = FoldSides(seen.label[i - 1]);
    if (seen.pixel[i] != seen.pixel[i - 1] + 1 || a == b) continue;
    const int jump_mm =
        static_cast<int>(view.at(seen.pixel[i])) - static_cast<int>(view.at(seen.pixel[i - 1]));
    if (std::abs(jump_mm) > kOneSurface_mm) continue;
    borders += 1;
    meeting += AreAdjacentParts(a, b) ? 1 : 0;
  }
  // One more border of each kind keeps the share near one half where there are few.
  return (meeting + 1) / (borders + 2);
}

void AddProbabilityFeatures(const Classification& seen, PersonFeatures& features) {
  const auto classes = static_cast<size_t>(seen.class_count);
  double certainty = 0, other = 0;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    const uint8_t label = seen.label[i], mirrored = recon::kMirroredPart[label];
    certainty += static_cast<double>(seen.Probability(i, label));
    if (mirrored != label) certainty += static_cast<double>(seen.Probability(i, mirrored));
    if (classes > recon::kOtherPart) {
      other += static_cast<double>(seen.Probability(i, recon::kOtherPart));
    }
  }
  const auto n = static_cast<double>(seen.pixel.size());
  features[static_cast<size_t>(PersonFeature::kCertainty)] = certainty / n;
  features[static_cast<size_t>(PersonFeature::kBody)] = 1 - other / n;
}

void AddShapeFeatures(const depth::DepthFrame& frame, const Classification& seen,
                      const std::vector<HeadCluster>& heads, PersonFeatures& features) {
  double area_m2 = 0, head_m2 = 0, above_m2 = 0;
  Vector3d torso = Vector3d::Zero();
  int torso_samples = 0;
  for (const HeadCluster& head : heads) head_m2 += head.area_m2;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    const Sample at = BackProjectSample(frame, seen.pixel[i]);
    area_m2 += at.area_m2;
    if (!heads.empty() && at.position_m.y() > heads.front().mean_m.y() + 0.2)
      above_m2 += at.area_m2;
    if (seen.label[i] < kFirstTorsoLabel || seen.label[i] > kLastTorsoLabel) continue;
    torso += at.position_m;
    ++torso_samples;
  }
  features[static_cast<size_t>(PersonFeature::kSmall)] = std::min(1.0, area_m2 / 0.25);
  features[static_cast<size_t>(PersonFeature::kLarge)] =
      std::clamp((area_m2 - 0.65) / 0.5, 0.0, 1.0);
  if (heads.empty()) return;
  features[static_cast<size_t>(PersonFeature::kHead)] = std::min(1.0, heads.front().area_m2 / 0.02);
  features[static_cast<size_t>(PersonFeature::kOneHead)] = heads.front().area_m2 / head_m2;
  features[static_cast<size_t>(PersonFeature::kAbove)] = above_m2 / area_m2;
  if (torso_samples == 0) return;
  const double apart_m = (torso / torso_samples - heads.front().mean_m).norm();
  features[static_cast<size_t>(PersonFeature::kTorsoBelow)] =
      std::exp(-std::pow((apart_m - 0.45) / 0.15, 2));
}

// Of the first `count` features: bias, features, and products of two (squares too), in this order.
template <size_t kCount>
double EvaluateLogistic(const PersonFeatures& features, const std::array<double, kCount>& weight,
                        size_t count) {
  double sum = weight[0];
  size_t next = 1;
  for (size_t i = 0; i < count; ++i) sum += weight[next++] * features[i];
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = i; j < count; ++j) sum += weight[next++] * features[i] * features[j];
  }
  return 1.0 / (1.0 + std::exp(-sum));
}

double BestConfidence(const std::vector<forest::Proposal>& modes) {
  return modes.empty() ? 0.0 : modes.front().confidence;
}

}  // namespace

std::vector<HeadCluster> FindHeadClusters(const depth::DepthFrame& frame,
                                          const Classification& seen) {
  std::vector<HeadCluster> heads;
  for (const Cluster& cluster : CollectHeadClusters(frame, seen))
    heads.push_back({cluster.mean(), cluster.area_m2});
  return heads;
}

double MeasureLegArea_m2(const depth::DepthFrame& frame, const Classification& seen) {
  constexpr int kFirstLegLabel = 22;  // by the convention of recon/body/parts.h
  double area_m2 = 0;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    if (seen.label[i] >= kFirstLegLabel && seen.label[i] < recon::kOtherPart)
      area_m2 += BackProjectSample(frame, seen.pixel[i]).area_m2;
  }
  return area_m2;
}

void AddSurfaceFeatures(const depth::DepthFrame& frame, const Candidate& candidate,
                        const Classification& seen, const std::vector<HeadCluster>& heads,
                        PersonFeatures& features) {
  const double z_m = static_cast<double>(candidate.region.mean_m.z());
  features[static_cast<size_t>(PersonFeature::kCoherence)] =
      MeasureCoherence(seen, frame.camera.width);
  features[static_cast<size_t>(PersonFeature::kHeadShape)] = candidate.has_head ? 1 : 0;
  features[static_cast<size_t>(PersonFeature::kFlat)] = candidate.flat_share;
  features[static_cast<size_t>(PersonFeature::kFar)] = z_m / 6;
  features[static_cast<size_t>(PersonFeature::kCompact)] = MeasureCompactness(frame, seen);
  features[static_cast<size_t>(PersonFeature::kNeighbours)] = MeasureNeighbourShare(frame, seen);
  AddProbabilityFeatures(seen, features);
  AddShapeFeatures(frame, seen, heads, features);
}

void AddProposalFeatures(const std::vector<std::vector<forest::Proposal>>& proposals,
                         const recon::JointArray<int>& targets, PersonFeatures& features) {
  using recon::Joint;
  constexpr std::array kCore = {Joint::kShoulderCenter, Joint::kHead, Joint::kShoulderLeft,
                                Joint::kShoulderRight, Joint::kSpine};
  const recon::BoneLengths average_m =
      recon::MeasureBoneLengths(recon::StandardPosture(recon::RigPose{}));
  double core = 0, all = 0, bones = 0;
  const auto modes_of = [&](size_t j) -> const std::vector<forest::Proposal>& {
    return proposals[static_cast<size_t>(targets[j])];
  };
  for (size_t j = 0; j < recon::kJointCount; ++j) all += BestConfidence(modes_of(j));
  const auto& centre = modes_of(recon::Index(Joint::kShoulderCenter));
  for (const Joint joint : kCore) {
    const auto& modes = modes_of(recon::Index(joint));
    core += BestConfidence(modes);
    if (joint == Joint::kShoulderCenter || modes.empty() || centre.empty()) continue;
    // The bone from spine to shoulder centre is stored with the latter, the others with the outer
    // joint.
    const auto bone = recon::Index(joint == Joint::kSpine ? Joint::kShoulderCenter : joint);
    const double length_m = (modes.front().position_m - centre.front().position_m).norm();
    bones += std::exp(-std::pow((length_m - average_m[bone]) / 0.07, 2));
  }
  features[static_cast<size_t>(PersonFeature::kTrust)] = core / kCore.size();
  features[static_cast<size_t>(PersonFeature::kAllTrust)] = all / recon::kJointCount;
  features[static_cast<size_t>(PersonFeature::kBones)] = bones / (kCore.size() - 1);
}

double ComputeSurfaceScore(const PersonFeatures& features, bool from_above) {
  constexpr auto kCount = static_cast<size_t>(PersonFeature::kTrust);
  static_assert(kSurfaceWeights.size() == CountTerms(kCount) &&
                    kSurfaceWeightsFromAbove.size() == CountTerms(kCount),
                "person_classifier_weights.inc is of other features");
  return EvaluateLogistic(features, from_above ? kSurfaceWeightsFromAbove : kSurfaceWeights,
                          kCount);
}

double ComputePersonScore(const PersonFeatures& features, bool from_above) {
  static_assert(kPersonWeights.size() == CountTerms(kPersonFeatureCount) &&
                    kPersonWeightsFromAbove.size() == CountTerms(kPersonFeatureCount),
                "person_classifier_weights.inc is of other features");
  return EvaluateLogistic(features, from_above ? kPersonWeightsFromAbove : kPersonWeights,
                          kPersonFeatureCount);
}

}  // namespace ossa::people
