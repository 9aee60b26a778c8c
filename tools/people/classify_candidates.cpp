#include "tools/people/classify_candidates.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "depth/base/threads.h"
#include "depth/scene/region_pixels.h"
#include "recon/body/standard_body.h"
#include "tools/people/join_pieces.h"
#include "tools/people/occlusion_merge.h"
#include "tools/people/pose_evidence.h"
#include "tools/people/split_regions.h"

namespace ossa::people {
namespace {

// The weight of the new frame in the mean over a track's frames.
double ComputeFrameWeight(int age, const TrackPriorOptions& options) {
  return std::max(1.0 / age, 1 - options.memory);
}

Detection Classify(const ClassificationInput& input, Candidate candidate) {
  const PeopleOptions& options = input.options;
  Detection detection;
  detection.prior = MakeTrackPrior(candidate, input.tracks, input.frame.time_s, options.prior);
  const TrackPrior& prior = detection.prior;
  const double min_score = candidate.track >= 0 ? 0.0 : options.evidence.min_surface_score;
  detection.evidence = ClassifyCandidate(input.classifier, input.frame, candidate, prior.facing,
                                         min_score, options.evidence);
  detection.score = detection.evidence.score;
  detection.age = prior.age + 1;
  if (prior.score) {
    const double weight = ComputeFrameWeight(detection.age, options.prior);
    detection.score = *prior.score + weight * (detection.score - *prior.score);
  }
  detection.candidate = std::move(candidate);
  return detection;
}

std::vector<Detection> ClassifyEach(const ClassificationInput& input,
                                    std::vector<Candidate> candidates) {
  std::vector<Detection> detections(candidates.size());
  ParallelFor(candidates.size(), input.options.threads,
              [&](size_t i) { detections[i] = Classify(input, std::move(candidates[i])); });
  return detections;
}

// Whether two detections merged are one person: the score is higher than that of either, or nearly
// as high where one is above the other, and there is one head. A second head may be a raised hand
// if one of the two is rejected alone and merging raises the score.
bool IsBetterMerged(const Detection& whole, const Detection& a, const Detection& b, bool stacked,
                    const PeopleOptions& options) {
  const auto [less, more] = std::minmax(a.evidence.score, b.evidence.score);
  const double score = whole.evidence.score;
  if (whole.evidence.heads_m.size() > 1)
    return less < options.initiation.new_person_score && score >= more;
  return score >= more - (stacked ? options.classification.max_stacked_score_loss : 0.0);
}

// Two detections merged, if the result is one person. Long-lived tracks are left alone.
std::optional<Detection> TryMerge(const ClassificationInput& input, const Detection& a,
                                  const Detection& b) {
  const ClassificationOptions& options = input.options.classification;
  const PlanarOccluderOptions& occluder = input.options.candidates.occluder;
  const bool stacked = AreStacked(input.scene, input.options, a, b);
  const bool one_region = a.candidate.region_index == b.candidate.region_index;
  if (!one_region && !MayBePartsOfOnePerson(input.scene, input.options, a, b, stacked)) return {};
  if (std::min(a.age, b.age) > options.mature_age) return {};
  if (Occludes(input.scene, a.candidate, b.candidate, occluder) ||
      Occludes(input.scene, b.candidate, a.candidate, occluder))
    return {};
  if (a.candidate.region.area_m2 + b.candidate.region.area_m2 > options.two_people_m2) return {};
  const bool a_first = a.age != b.age ? a.age > b.age : a.evidence.score >= b.evidence.score;
  const Candidate& first = a_first ? a.candidate : b.candidate;
  const Candidate& second = a_first ? b.candidate : a.candidate;
  Detection whole = Classify(input, MergeCandidates(input.scene, input.frame, first, second));
  if (!IsBetterMerged(whole, a, b, stacked, input.options)) return {};
  return whole;
}

// Merges pairs until none is left. Rejected candidates take part, because they may be parts of a
// person.
template <typename Try>
void MergePairs(const ClassificationInput& input, const Try& try_as_one,
                std::vector<Detection>& detections, std::vector<Decision>& decided) {
  for (size_t i = 0; i < detections.size(); ++i) {
    for (size_t k = i + 1; k < detections.size(); ++k) {
      auto whole = try_as_one(input, detections[i], detections[k]);
      if (!whole) continue;
      decided.push_back(DescribeDetection(detections[i], Rule::kMerged, whole->evidence.score));
      decided.push_back(DescribeDetection(detections[k], Rule::kMerged, whole->evidence.score));
      detections[i] = std::move(*whole);
      detections.erase(detections.begin() + static_cast<std::ptrdiff_t>(k));
      k = i;
    }
  }
}

// A detection with several heads, split; empty unless at least two segments are accepted by
// themselves.
std::vector<Detection> SplitAtHeads(const ClassificationInput& input, const Detection& whole,
                                    std::vector<Decision>& decided) {
  const PeopleOptions& options = input.options;
  if (whole.evidence.heads_m.size() < 2 || !MayBeTwoPeople(whole, options.classification))
    return {};
  auto cut = SplitCandidate(input.scene, input.frame, whole.candidate, whole.evidence.heads_m,
                            options.candidates);
  if (cut.size() < 2) return {};
  std::vector<Detection> pieces = ClassifyEach(input, std::move(cut));
  const double needed = options.initiation.new_person_score;
  const auto others = std::stable_partition(
      pieces.begin(), pieces.end(), [&](const Detection& piece) { return piece.score >= needed; });
  if (others - pieces.begin() < 2) return {};
  for (auto other = others; other != pieces.end(); ++other)
    decided.push_back(DescribeDetection(*other, Rule::kPieceLowScore, needed));
  pieces.erase(others, pieces.end());
  for (Detection& piece : pieces) piece.is_piece = true;
  decided.push_back(DescribeDetection(whole, Rule::kSplitAtHeads, needed));
  return pieces;
}

// Combines the score with the pose network's. New candidates: unless they are foreground or were
// split off a tracked person, where too little may be visible. Tracks: only where the forest is not
// confident, and only upwards, because the network is unreliable for people who leave the view.
void ApplyPoseNetwork(const ClassificationInput& input, Detection& detection) {
  const PeopleOptions& options = input.options;
  const bool is_new = detection.candidate.track < 0;
  const double forest = detection.evidence.score;
  if (forest < options.evidence.min_surface_score) return;
  const bool little_seen = IsForeground(detection.candidate) || detection.candidate.may_return ||
                           (detection.is_piece && !input.scene.fresh);
  if (is_new ? little_seen : forest >= options.initiation.confident_score) return;
  detection.pose = ReadPose(*input.classifier.network, input.frame, detection.candidate.pixels);
  if (!detection.pose) return;
  const double score = ComputeScoreWithPose(forest, MeasureCertainty(*detection.pose));
  if (!is_new && score < forest) return;
  const bool contested = forest >= options.initiation.confident_score &&
                         score >= options.initiation.contested_score &&
                         score < options.initiation.person_by_pose_score;
  detection.verifier = contested ? Verifier::kSurfaceFit : Verifier::kForestAndNetwork;
  if (contested) return;
  detection.score += ComputeFrameWeight(detection.age, options.prior) * (score - forest);
  detection.evidence.score = score;
}

bool PassesByPose(const Detection& detection, const InitiationOptions& options) {
  return IsVerifiedByPose(detection) && detection.evidence.score >= options.person_by_pose_score;
}

// Two detections merged, if the network estimates the same joints for both.
std::optional<Detection> TryMergeBySamePose(const ClassificationInput& input, const Detection& a,
                                            const Detection& b) {
  const ClassificationOptions& options = input.options.classification;
  const float apart_m = (a.candidate.region.mean_m - b.candidate.region.mean_m).norm();
  if (apart_m > options.pieces_m) return {};
  const InitiationOptions& initiation = input.options.initiation;
  if (!PassesByPose(a, initiation) || !PassesByPose(b, initiation)) return {};
  if (MeasureDistance_m(*a.pose, *b.pose) > static_cast<double>(options.same_pose_m)) return {};
  const bool a_first = a.evidence.score >= b.evidence.score;
  Detection whole =
      Classify(input, MergeCandidates(input.scene, input.frame, (a_first ? a : b).candidate,
                                      (a_first ? b : a).candidate));
  ApplyPoseNetwork(input, whole);
  if (!IsVerifiedByPose(whole)) return {};
  // Each of the two shows this person, so that together they are no less certain than alone.
  const double least = std::max(a.evidence.score, b.evidence.score);
  whole.evidence.score = std::max(whole.evidence.score, least);
  whole.score = std::max(whole.score, least);
  return whole;
}

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

bool Passes(const Detection& detection, const InitiationOptions& options) {
  return detection.score >=
         (IsVerifiedByPose(detection) ? options.person_by_pose_score : options.new_person_score);
}

bool HasPerson(const std::vector<Detection>& detections, const InitiationOptions& options) {
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& detection) {
    return detection.candidate.track >= 0 || Passes(detection, options);
  });
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

// A rejected candidate may be a person with the furniture they touch. Tried only in frames without
// people: beside a person it would as often be an object they hold.
void RetryAroundHeads(const ClassificationInput& input, std::vector<Detection>& detections,
                      std::vector<Decision>& decided) {
  for (Detection& detection : detections) CropAroundHeads(input, detection, decided);
}

// The connected region of a tracked person includes that furniture again in each frame, unless the
// known background separates it.
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

// The merged person replaces the detections it consists of.
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

// Bones between the joint proposals, from the trunk outwards as far as they are connected: for each
// joint the best proposal at a plausible bone length from its parent.
std::vector<Bone> ConnectBones(const JointTargets& targets, const ForestEvidence& evidence,
                               double max_bone_ratio) {
  using recon::Joint;
  const recon::BoneLengths average_m =
      recon::MeasureBoneLengths(recon::StandardPosture(recon::RigPose{}));
  const auto modes_of = [&](size_t j) -> const std::vector<forest::Proposal>& {
    return evidence.proposals.at(static_cast<size_t>(targets[j]));
  };
  recon::JointArray<const forest::Proposal*> reached{};
  std::vector<Bone> bones;
  const auto reach = [&](size_t from, size_t to, size_t bone) {
    const Eigen::Vector3d& from_m = reached[from]->position_m;
    for (const forest::Proposal& mode : modes_of(to)) {
      if ((mode.position_m - from_m).norm() > max_bone_ratio * average_m[bone]) continue;
      reached[to] = &mode;
      bones.push_back({from_m.cast<float>(), mode.position_m.cast<float>()});
      return;
    }
  };
  // The shoulders' middle is the surest; from there down to the hips, and parents before children.
  constexpr auto kCentre = recon::Index(Joint::kShoulderCenter);
  constexpr auto kSpine = recon::Index(Joint::kSpine);
  if (modes_of(kCentre).empty()) return bones;
  reached[kCentre] = &modes_of(kCentre).front();
  reach(kCentre, kSpine, kCentre);
  if (reached[kSpine]) reach(kSpine, 0, kSpine);
  for (size_t j = kCentre + 1; j < recon::kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    if (reached[parent]) reach(parent, j, j);
  }
  return bones;
}

// Whether the region extends beyond the bounding box of the bones by more than `reach_m`.
bool ReachesBeyond(const std::vector<Bone>& bones, const Region& region, float reach_m) {
  Eigen::Vector3f low_m = region.high_m, high_m = region.low_m;
  for (const Bone& bone : bones) {
    low_m = low_m.cwiseMin(bone.from_m).cwiseMin(bone.to_m);
    high_m = high_m.cwiseMax(bone.from_m).cwiseMax(bone.to_m);
  }
  return ((low_m - region.low_m).array() > reach_m).any() ||
         ((region.high_m - high_m).array() > reach_m).any();
}

}  // namespace

TrackPrior MakeTrackPrior(const Candidate& candidate, const std::vector<Track>& tracks,
                          double time_s, const TrackPriorOptions& options) {
  TrackPrior prior;
  if (candidate.track < 0) return prior;
  const Track& track = tracks[static_cast<size_t>(candidate.track)];
  prior.score = track.score;
  prior.age = track.age;
  prior.moved = track.moved;
  prior.moving = time_s - track.moved_s < options.moving_s;
  prior.full_m2 = track.full_m2;
  // The heading in the previous frame is a prior of the heading now.
  const bool recent = !track.facing.empty() && time_s - track.facing_s <= options.facing_s;
  if (track.age < options.min_facing_age || !recent) return prior;
  prior.facing = track.facing;
  const float fresh = options.fresh_facing;
  for (float& share : prior.facing)
    share = (1 - fresh) * share + fresh / static_cast<float>(prior.facing.size());
  return prior;
}

bool IsVerifiedByPose(const Detection& detection) {
  return detection.verifier == Verifier::kForestAndNetwork;
}

Decision DescribeDetection(const Detection& detection, Rule rule, double needed_score) {
  Decision decision = DescribeRegion(detection.candidate.region, rule);
  decision.classified = true;
  decision.score = detection.evidence.score;
  decision.mean_score = detection.score;
  decision.needed_score = needed_score;
  decision.observations = detection.age;
  return decision;
}

bool AreStacked(const Scene& scene, const PeopleOptions& options, const Detection& a,
                const Detection& b) {
  const Region &of_a = a.candidate.region, &of_b = b.candidate.region;
  const Eigen::Vector3f apart_m = of_a.mean_m - of_b.mean_m;
  const bool both_people =
      std::min(a.evidence.score, b.evidence.score) >= options.initiation.new_person_score;
  const float limit_m =
      both_people ? options.classification.leaning_m : options.classification.stacked_m;
  return std::hypot(apart_m.x(), apart_m.z()) < limit_m ||
         IsOneAboveOther(scene.grid, of_a, of_b, options.candidates.occlusion);
}

bool MayBePartsOfOnePerson(const Scene& scene, const PeopleOptions& options, const Detection& a,
                           const Detection& b, bool stacked) {
  const auto [less, more] = std::minmax(a.evidence.score, b.evidence.score);
  const double person = options.initiation.new_person_score;
  if (stacked && less >= person) return true;
  return std::max(a.age, b.age) <= options.initiation.early_age && more >= person &&
         MeetAlongRim(scene, a.candidate, b.candidate, options.classification);
}

bool MayBeTwoPeople(const Detection& whole, const ClassificationOptions& options) {
  return whole.age <= options.mature_age ||
         whole.candidate.region.area_m2 > options.grown_share * whole.prior.full_m2;
}

void CropToBody(const JointTargets& targets, const DepthFrame& frame, const Scene& scene,
                const ClassificationOptions& options, Detection& detection) {
  constexpr size_t kAllBones = recon::kJointCount - 1;
  const auto bones = ConnectBones(targets, detection.evidence, options.max_bone_ratio);
  if (bones.size() < options.min_crop_bones) return;
  const Region& region = detection.candidate.region;
  const bool large = region.area_m2 >= options.crop_area_m2;
  const bool whole = bones.size() == kAllBones && ReachesBeyond(bones, region, options.crop_far_m);
  if (!large && !whole) return;
  const size_t whole_pixels = detection.candidate.pixels.size();
  CropToBones(scene, frame, bones, large ? options.crop_m : options.crop_far_m,
              options.min_cropped_cells, detection.candidate);
  if (detection.candidate.pixels.size() != whole_pixels) detection.pose.reset();
}

std::vector<Detection> ClassifyCandidates(const ClassificationInput& input,
                                          std::vector<Candidate> candidates,
                                          std::vector<Decision>& decided) {
  std::vector<Detection> detections = ClassifyEach(input, std::move(candidates));
  // From above, geometry alone separates people.
  if (input.options.candidates.overhead) return detections;
  MergePairs(input, TryMerge, detections, decided);
  std::vector<Detection> result;
  for (Detection& detection : detections) {
    std::vector<Detection> pieces = SplitAtHeads(input, detection, decided);
    if (pieces.empty()) {
      result.push_back(std::move(detection));
    } else {
      std::move(pieces.begin(), pieces.end(), std::back_inserter(result));
    }
  }
  if (input.classifier.network == nullptr) return result;
  ParallelFor(result.size(), input.options.threads,
              [&](size_t i) { ApplyPoseNetwork(input, result[i]); });
  CropTracksAroundHeads(input, result, decided);
  if (!input.scene.fresh) return result;
  const InitiationOptions& initiation = input.options.initiation;
  if (!HasPerson(result, initiation)) RetryAroundHeads(input, result, decided);
  if (!HasPerson(result, initiation)) RetryWithJoinedPieces(input, result, decided);
  MergePairs(input, TryMergeBySamePose, result, decided);
  return result;
}

}  // namespace ossa::people
