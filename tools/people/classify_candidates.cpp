#include "tools/people/classify_candidates.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "depth/base/threads.h"
#include "tools/people/classify_detection.h"
#include "tools/people/occlusion_merge.h"
#include "tools/people/partial_people.h"
#include "tools/people/pose_evidence.h"
#include "tools/people/split_regions.h"
#include "tools/people/track_initiation.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

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

// Whether `part` belongs to somebody else than the person of `track`.
bool IsSomebodyElse(const ClassificationInput& input, const Detection& part,
                    const Detection& track) {
  const PeopleOptions& options = input.options;
  return MayReturnBeside(input.scene.grid, part, track, input.tracks, input.frame.time_s,
                         options) ||
         IsOfOtherTrack(part, track, input.tracks, options.classification);
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
  if (IsSomebodyElse(input, a, b) || IsSomebodyElse(input, b, a)) return {};
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
  const int track = whole.candidate.track;
  if (track >= 0) {
    cut[FindSegmentOf(input.scene.grid, input.tracks[static_cast<size_t>(track)], cut,
                      input.frame.time_s, options.candidates.prediction)]
        .track = track;
  }
  std::vector<Detection> pieces = ClassifyEach(input, std::move(cut));
  const bool one_so_far = !input.scene.fresh && whole.candidate.track >= 0;
  const auto needed = [&](const Detection& piece) {
    return RequireOfPiece(piece, one_so_far, options.initiation);
  };
  const auto others =
      std::stable_partition(pieces.begin(), pieces.end(),
                            [&](const Detection& piece) { return piece.score >= needed(piece); });
  if (others - pieces.begin() < 2) return {};
  for (auto other = others; other != pieces.end(); ++other)
    decided.push_back(DescribeDetection(*other, Rule::kPieceLowScore, needed(*other)));
  pieces.erase(others, pieces.end());
  // Of a new region in a known scene each is new: furniture, too, may seem to have two heads.
  const bool known = !input.scene.fresh && !IsForeground(whole.candidate);
  for (Detection& piece : pieces) {
    piece.is_piece = !known || track >= 0;
    piece.is_cut_off = known && piece.candidate.track < 0;
  }
  decided.push_back(
      DescribeDetection(whole, Rule::kSplitAtHeads, options.initiation.new_person_score));
  return pieces;
}

bool MayBeHalfByPose(const Detection& detection, const InitiationOptions& options) {
  return IsVerifiedByPose(detection) && detection.evidence.score >= options.weak_by_pose_score;
}

// Two detections merged, if the network estimates the same joints for both.
std::optional<Detection> TryMergeBySamePose(const ClassificationInput& input, const Detection& a,
                                            const Detection& b) {
  const ClassificationOptions& options = input.options.classification;
  const float apart_m = (a.candidate.region.mean_m - b.candidate.region.mean_m).norm();
  if (apart_m > options.pieces_m) return {};
  const InitiationOptions& initiation = input.options.initiation;
  if (!MayBeHalfByPose(a, initiation) || !MayBeHalfByPose(b, initiation)) return {};
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

bool HasPerson(const std::vector<Detection>& detections, const InitiationOptions& options) {
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& detection) {
    return detection.candidate.track >= 0 || Passes(detection, options);
  });
}

}  // namespace

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

bool MayReturnBeside(const PointGrid& grid, const Detection& part, const Detection& track,
                     const std::vector<Track>& tracks, double time_s,
                     const PeopleOptions& options) {
  if (part.candidate.track >= 0 || track.candidate.track < 0) return false;
  if (track.age <= options.classification.mature_age) return false;
  return MayBeReturning(grid, part.candidate, tracks[static_cast<size_t>(track.candidate.track)],
                        tracks, time_s, options.candidates);
}

bool IsOfOtherTrack(const Detection& part, const Detection& track, const std::vector<Track>& tracks,
                    const ClassificationOptions& options) {
  const int owner = part.candidate.owner;
  return part.candidate.track < 0 && owner >= 0 && track.candidate.track >= 0 &&
         owner != track.candidate.track &&
         tracks[static_cast<size_t>(owner)].age > options.mature_age;
}

size_t FindSegmentOf(const PointGrid& grid, const Track& track,
                     const std::vector<Candidate>& segments, double time_s,
                     const PredictionOptions& options) {
  const std::vector<int> owner = PredictOwners(grid, {track}, time_s, options);
  const auto covered = [&](const Candidate& segment) {
    return CollectOverlaps(segment.region, owner, 1).front().size();
  };
  return static_cast<size_t>(std::ranges::max_element(segments, {}, covered) - segments.begin());
}

bool MayBeTwoPeople(const Detection& whole, const ClassificationOptions& options) {
  return whole.age <= options.mature_age ||
         whole.candidate.region.area_m2 > options.grown_share * whole.prior.full_m2;
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
  CropLikelyAroundHeads(input, result, decided);
  if (!input.scene.fresh && !input.thorough) return result;
  const InitiationOptions& initiation = input.options.initiation;
  if (!HasPerson(result, initiation)) RetryAroundHeads(input, result, decided);
  if (!HasPerson(result, initiation)) RetryWithJoinedPieces(input, result, decided);
  MergePairs(input, TryMergeBySamePose, result, decided);
  return result;
}

}  // namespace ossa::people
