#include "tools/people/partial_people.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "depth/scene/region_pixels.h"
#include "tools/people/classify_detection.h"
#include "tools/people/join_pieces.h"
#include "tools/people/split_regions.h"

namespace ossa::people {
namespace {

// The segment within `reach_m` of a head over the surface, if it is much smaller than the whole and
// has a high score.
std::optional<Detection> ClassifyAroundHead(const ClassificationInput& input,
                                            const Candidate& whole, const Eigen::Vector3f& head_m,
                                            float reach_m) {
  const CandidateOptions& options = input.options.candidates;
  const ClassificationOptions& classification = input.options.classification;
  const Seed seed{CollectHeadCells(input.scene.grid, whole.region, head_m, options.seeds), reach_m,
                  nullptr};
  Region piece = SplitBySeeds(input.scene.grid, whole.region, {seed}, options.seeds).front();
  if (!IsPersonSized(piece, options) ||
      piece.area_m2 > classification.max_head_piece_share * whole.region.area_m2)
    return {};
  Candidate part = whole;
  part.pixels = CollectPixels(input.frame, input.scene.grid, piece);
  part.region = std::move(piece);
  part.has_head = true;
  part.plane.reset();
  Detection detection = Classify(input, std::move(part));
  ApplyPoseNetwork(input, detection);
  // Of tracks the network is not asked where the forest is confident.
  const bool is_sure_track = detection.candidate.track >= 0 &&
                             detection.evidence.score >= input.options.initiation.confident_score;
  const bool is_verified = IsVerifiedByPose(detection) || is_sure_track;
  if (!is_verified || detection.evidence.score < classification.head_piece_score) return {};
  return detection;
}

// Heads detected by shape and by the forest, without duplicates.
std::vector<Eigen::Vector3f> ListHeads(const ClassificationInput& input,
                                       const Detection& detection) {
  const HeadOptions& options = input.options.candidates.heads;
  std::vector<Eigen::Vector3f> heads_m;
  for (const HeadBlob& head : FindHeads(input.scene.grid, detection.candidate.region, options))
    heads_m.push_back(head.position_m);
  for (const Eigen::Vector3d& head_m : detection.evidence.heads_m) {
    const Eigen::Vector3f place_m = head_m.cast<float>();
    const auto is_same = [&](const Eigen::Vector3f& other_m) {
      return (other_m - place_m).norm() < options.min_distance_m;
    };
    if (std::none_of(heads_m.begin(), heads_m.end(), is_same)) heads_m.push_back(place_m);
  }
  return heads_m;
}

// The segment with the highest score around one of the heads: within the reach of a whole body,
// else of a trunk.
std::optional<Detection> FindPersonAroundHeads(const ClassificationInput& input,
                                               const Detection& whole) {
  const auto heads_m = ListHeads(input, whole);
  for (const float reach_m : input.options.classification.head_piece_reach_m) {
    std::optional<Detection> best;
    for (const Eigen::Vector3f& head_m : heads_m) {
      auto piece = ClassifyAroundHead(input, whole.candidate, head_m, reach_m);
      if (piece && (!best || piece->evidence.score > best->evidence.score)) best = std::move(piece);
    }
    if (best) return best;
  }
  return {};
}

// Replaces a detection by the person around one of its heads, if there is one.
void CropAroundHeads(const ClassificationInput& input, Detection& detection,
                     std::vector<Decision>& decided) {
  auto piece = FindPersonAroundHeads(input, detection);
  if (!piece) return;
  decided.push_back(DescribeDetection(detection, Rule::kSplitAtHeads,
                                      input.options.initiation.person_by_pose_score));
  detection = std::move(*piece);
}

// Rejected regions, most of them too small to be candidates, may be one person whose middle an arm
// or a held object occludes.
std::optional<Detection> FindPersonInPieces(const ClassificationInput& input) {
  const CandidateOptions& options = input.options.candidates;
  const auto classify = [&](Region region) {
    Detection detection = Classify(
        input, MakeCandidate(input.frame, input.scene, std::move(region), true, -1, options));
    ApplyPoseNetwork(input, detection);
    return detection;
  };
  const std::vector<Region> pieces = depth::FindConnectedRegions(
      input.scene.grid, input.scene.surfaces.room, options.join.piece_m2);
  std::vector<Detection> wholes = GrowAcrossDepthEdges(input.scene.grid, pieces, classify, options);
  std::erase_if(wholes, [&](const Detection& whole) {
    const Region& region = whole.candidate.region;
    const bool shows_enough = IsPersonSized(region, options) ||
                              IsCutByLowerBorder(input.scene.grid, region, options.join);
    return !shows_enough || !IsVerifiedByPose(whole) || !Passes(whole, input.options.initiation);
  });
  const auto best = std::ranges::max_element(wholes, {}, GetPersonScore);
  if (best == wholes.end()) return {};
  best->is_joined = true;
  return std::move(*best);
}

}  // namespace

void RetryAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                      std::vector<Decision>& decided) {
  for (Detection& detection : detections) CropAroundHeads(input, detection, decided);
}

void CropTracksAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                           std::vector<Decision>& decided) {
  const InitiationOptions& options = input.options.initiation;
  for (Detection& detection : detections) {
    if (detection.candidate.track < 0 || IsForeground(detection.candidate)) continue;
    const bool is_certain =
        Passes(detection, options) && detection.evidence.score >= options.person_by_pose_score;
    if (!is_certain) CropAroundHeads(input, detection, decided);
  }
}

void CropLikelyAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                           std::vector<Decision>& decided) {
  for (Detection& detection : detections) {
    if (!detection.candidate.holds_likely_person) continue;
    if (!Passes(detection, input.options.initiation)) CropAroundHeads(input, detection, decided);
  }
}

void RetryWithJoinedPieces(const ClassificationInput& input, std::vector<Detection>& detections,
                           std::vector<Decision>& decided) {
  auto whole = FindPersonInPieces(input);
  if (!whole) return;
  const std::vector<int>& cells = whole->candidate.region.cells;
  const auto is_part = [&](const Detection& detection) {
    return std::ranges::any_of(detection.candidate.region.cells, [&](int cell) {
      return std::binary_search(cells.begin(), cells.end(), cell);
    });
  };
  for (const Detection& detection : detections) {
    if (is_part(detection))
      decided.push_back(DescribeDetection(detection, Rule::kMerged, whole->evidence.score));
  }
  std::erase_if(detections, is_part);
  detections.push_back(std::move(*whole));
}

}  // namespace ossa::people
