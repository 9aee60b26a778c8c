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

// What a frame counts in the mean over a track's frames.
double WeighLook(int age, const TrackPriorOptions& options) {
  return std::max(1.0 / age, 1 - options.memory);
}

Detection Classify(const Classifying& with, Candidate candidate) {
  const PeopleOptions& options = with.options;
  Detection detection;
  detection.prior = MakeTrackPrior(candidate, with.tracks, with.frame.time_s, options.prior);
  const TrackPrior& prior = detection.prior;
  const double min_score = candidate.track >= 0 ? 0.0 : options.evidence.min_surface_score;
  detection.evidence = ClassifyCandidate(with.classifier, with.frame, candidate, prior.facing,
                                         min_score, options.evidence);
  detection.score = detection.evidence.score;
  detection.age = prior.age + 1;
  if (prior.score) {
    const double weight = WeighLook(detection.age, options.prior);
    detection.score = *prior.score + weight * (detection.score - *prior.score);
  }
  detection.candidate = std::move(candidate);
  return detection;
}

std::vector<Detection> ClassifyEach(const Classifying& with, std::vector<Candidate> candidates) {
  std::vector<Detection> detections(candidates.size());
  ParallelFor(candidates.size(), with.options.threads,
              [&](size_t i) { detections[i] = Classify(with, std::move(candidates[i])); });
  return detections;
}

// Whether the whole of two pieces is one person: it looks more like a person than either piece, or
// about as much when one is above the other, and has one head. What looks like a second head is a
// lifted hand where one of the pieces is no person, and the whole is one the more.
bool IsOnePerson(const Detection& whole, const Detection& a, const Detection& b, bool stacked,
                 const PeopleOptions& options) {
  const auto [less, more] = std::minmax(a.evidence.score, b.evidence.score);
  const double score = whole.evidence.score;
  if (whole.evidence.heads_m.size() > 1)
    return less < options.initiation.new_person && score >= more;
  return score >= more - (stacked ? options.classification.stacked_loss : 0.0);
}

// Two pieces as one person, if that is what they are. People tracked for long are left as they are.
std::optional<Detection> TryAsOne(const Classifying& with, const Detection& a, const Detection& b) {
  const ClassificationOptions& options = with.options.classification;
  const PlanarOccluderOptions& occluder = with.options.candidates.occluder;
  const bool stacked = AreStacked(with.scene, with.options, a, b);
  const bool one_region = a.candidate.region_index == b.candidate.region_index;
  if (!one_region && !MayBePartsOfOne(with.scene, with.options, a, b, stacked)) return {};
  if (std::min(a.age, b.age) > options.mature_age) return {};
  if (Occludes(with.scene, a.candidate, b.candidate, occluder) ||
      Occludes(with.scene, b.candidate, a.candidate, occluder))
    return {};
  if (a.candidate.region.area_m2 + b.candidate.region.area_m2 > options.two_people_m2) return {};
  const bool a_first = a.age != b.age ? a.age > b.age : a.evidence.score >= b.evidence.score;
  const Candidate& first = a_first ? a.candidate : b.candidate;
  const Candidate& second = a_first ? b.candidate : a.candidate;
  Detection whole = Classify(with, MergeCandidates(with.scene, with.frame, first, second));
  if (!IsOnePerson(whole, a, b, stacked, with.options)) return {};
  return whole;
}

// Until nothing belongs together any more. What is no person alone may be part of one.
template <typename Try>
void MergeParts(const Classifying& with, const Try& try_as_one, std::vector<Detection>& detections,
                std::vector<Decision>& decided) {
  for (size_t i = 0; i < detections.size(); ++i) {
    for (size_t k = i + 1; k < detections.size(); ++k) {
      auto whole = try_as_one(with, detections[i], detections[k]);
      if (!whole) continue;
      decided.push_back(DescribeDetection(detections[i], Rule::kMerged, whole->evidence.score));
      decided.push_back(DescribeDetection(detections[k], Rule::kMerged, whole->evidence.score));
      detections[i] = std::move(*whole);
      detections.erase(detections.begin() + static_cast<std::ptrdiff_t>(k));
      k = i;
    }
  }
}

// A detection with several heads, cut; empty unless at least two of the pieces are people
// themselves.
std::vector<Detection> CutAtHeads(const Classifying& with, const Detection& whole,
                                  std::vector<Decision>& decided) {
  const PeopleOptions& options = with.options;
  if (whole.evidence.heads_m.size() < 2 || !MayBeTwo(whole, options.classification)) return {};
  auto cut = SplitCandidate(with.scene, with.frame, whole.candidate, whole.evidence.heads_m,
                            options.candidates);
  if (cut.size() < 2) return {};
  std::vector<Detection> pieces = ClassifyEach(with, std::move(cut));
  const double needed = options.initiation.new_person;
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

// Of what is new the network has its say, unless it came before a known background or was cut off
// somebody: little may be seen of that. Of somebody who is tracked, where the forest is in doubt,
// it may only say that they still look like a person, for it knows little of who goes out of sight.
void WeighPose(const Classifying& with, Detection& detection) {
  const PeopleOptions& options = with.options;
  const bool is_new = detection.candidate.track < 0;
  const double forest = detection.evidence.score;
  if (forest < options.evidence.min_surface_score) return;
  const bool little_seen = IsForeground(detection.candidate) || detection.candidate.may_return ||
                           (detection.is_piece && !with.scene.fresh);
  if (is_new ? little_seen : forest >= options.initiation.sure_person) return;
  detection.pose = ReadPose(*with.classifier.network, with.frame, detection.candidate.pixels);
  if (!detection.pose) return;
  const double score = ComputeScoreWithPose(forest, MeasureCertainty(*detection.pose));
  if (!is_new && score < forest) return;
  const bool contested = forest >= options.initiation.sure_person &&
                         score >= options.initiation.contested_person &&
                         score < options.initiation.person_by_pose;
  detection.judge = contested ? Judge::kSurfaceFit : Judge::kForestAndNetwork;
  if (contested) return;
  detection.score += WeighLook(detection.age, options.prior) * (score - forest);
  detection.evidence.score = score;
}

bool PassesByPose(const Detection& detection, const InitiationOptions& options) {
  return IsJudgedByPose(detection) && detection.evidence.score >= options.person_by_pose;
}

// Two pieces as one person, where the network reads the same joints in either.
std::optional<Detection> TryAsSamePose(const Classifying& with, const Detection& a,
                                       const Detection& b) {
  const ClassificationOptions& options = with.options.classification;
  const float apart_m = (a.candidate.region.mean_m - b.candidate.region.mean_m).norm();
  if (apart_m > options.pieces_m) return {};
  const InitiationOptions& initiation = with.options.initiation;
  if (!PassesByPose(a, initiation) || !PassesByPose(b, initiation)) return {};
  if (MeasureDistance_m(*a.pose, *b.pose) > static_cast<double>(options.same_pose_m)) return {};
  const bool a_first = a.evidence.score >= b.evidence.score;
  Detection whole =
      Classify(with, MergeCandidates(with.scene, with.frame, (a_first ? a : b).candidate,
                                     (a_first ? b : a).candidate));
  WeighPose(with, whole);
  if (!PassesByPose(whole, initiation)) return {};
  return whole;
}

// What lies within `reach_m` of a head over the surface, if that is much less than the whole and
// surely somebody.
std::optional<Detection> ClassifyAroundHead(const Classifying& with, const Candidate& whole,
                                            const Eigen::Vector3f& head_m, float reach_m) {
  const CandidateOptions& options = with.options.candidates;
  const ClassificationOptions& classification = with.options.classification;
  const Seed seed{CollectHeadCells(with.scene.grid, whole.region, head_m, options.seeds), reach_m,
                  nullptr};
  Region piece = SplitBySeeds(with.scene.grid, whole.region, {seed}, options.seeds).front();
  if (!IsPersonSized(piece, options) ||
      piece.area_m2 > classification.touching_share * whole.region.area_m2)
    return {};
  Candidate part = whole;
  part.pixels = CollectPixels(with.frame, with.scene.grid, piece);
  part.region = std::move(piece);
  part.has_head = true;
  part.plane.reset();
  Detection detection = Classify(with, std::move(part));
  WeighPose(with, detection);
  if (!IsJudgedByPose(detection) || detection.evidence.score < classification.touching_person)
    return {};
  return detection;
}

// Heads by their shape, and by the forest.
std::vector<Eigen::Vector3f> ListHeads(const Classifying& with, const Detection& detection) {
  const HeadOptions& options = with.options.candidates.heads;
  std::vector<Eigen::Vector3f> heads_m;
  for (const HeadBlob& head : FindHeads(with.scene.grid, detection.candidate.region, options))
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

// The surest piece around one of its heads, as far as a body reaches, else as a trunk.
std::optional<Detection> FindSomebodyWithin(const Classifying& with, const Detection& whole) {
  const auto heads_m = ListHeads(with, whole);
  for (const float reach_m : with.options.classification.touching_reach_m) {
    std::optional<Detection> best;
    for (const Eigen::Vector3f& head_m : heads_m) {
      auto piece = ClassifyAroundHead(with, whole.candidate, head_m, reach_m);
      if (piece && (!best || piece->evidence.score > best->evidence.score)) best = std::move(piece);
    }
    if (best) return best;
  }
  return {};
}

bool Passes(const Detection& detection, const InitiationOptions& options) {
  return detection.score >=
         (IsJudgedByPose(detection) ? options.person_by_pose : options.new_person);
}

bool IsAnybodyFound(const std::vector<Detection>& detections, const InitiationOptions& options) {
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& detection) {
    return detection.candidate.track >= 0 || Passes(detection, options);
  });
}

// What is no person as it stands may be one and the furniture that they touch. Beside somebody it
// would as often be what they hold.
void LookAgainAroundHeads(const Classifying& with, std::vector<Detection>& detections,
                          std::vector<Decision>& decided) {
  const double needed = with.options.initiation.person_by_pose;
  for (Detection& detection : detections) {
    auto piece = FindSomebodyWithin(with, detection);
    if (!piece) continue;
    decided.push_back(DescribeDetection(detection, Rule::kSplitAtHeads, needed));
    detection = std::move(*piece);
  }
}

// Pieces that are nobody, and of which most are too small to be asked about, may be one person of
// whom an arm or something held up occludes the middle.
std::optional<Detection> FindSomebodyInPieces(const Classifying& with) {
  const CandidateOptions& options = with.options.candidates;
  const auto classify = [&](Region region) {
    Detection detection =
        Classify(with, MakeCandidate(with.frame, with.scene, std::move(region), true, -1, options));
    WeighPose(with, detection);
    return detection;
  };
  const std::vector<Region> pieces =
      depth::FindConnectedRegions(with.scene.grid, with.scene.surfaces.room, options.join.piece_m2);
  std::vector<Detection> wholes = GrowOverEdges(with.scene.grid, pieces, classify, options);
  std::erase_if(wholes, [&](const Detection& whole) {
    const Region& region = whole.candidate.region;
    const bool shows_enough =
        IsPersonSized(region, options) || GoesOnBelow(with.scene.grid, region, options.join);
    return !shows_enough || !IsJudgedByPose(whole) || !Passes(whole, with.options.initiation);
  });
  const auto best = std::ranges::max_element(wholes, {}, MeasureLikeness);
  if (best == wholes.end()) return {};
  best->is_joined = true;
  return std::move(*best);
}

// A person that was found in pieces takes the place of what these were.
void LookAgainOverEdges(const Classifying& with, std::vector<Detection>& detections,
                        std::vector<Decision>& decided) {
  auto whole = FindSomebodyInPieces(with);
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

// Bones between proposals of neighbouring joints, as far as they hang together from the trunk
// outwards: of each joint the best proposal at about a bone's length from the one before.
std::vector<Bone> ConnectBones(const JointTargets& targets, const ForestEvidence& evidence,
                               double max_bone) {
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
      if ((mode.position_m - from_m).norm() > max_bone * average_m[bone]) continue;
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

// Whether any of it lies so far outside the box around the bones.
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
  // Which way a person faced a moment ago says much of the way now.
  const bool recent = !track.facing.empty() && time_s - track.facing_s <= options.facing_s;
  if (track.age < options.min_facing_age || !recent) return prior;
  prior.facing = track.facing;
  const float fresh = options.fresh_facing;
  for (float& share : prior.facing)
    share = (1 - fresh) * share + fresh / static_cast<float>(prior.facing.size());
  return prior;
}

bool IsJudgedByPose(const Detection& detection) {
  return detection.judge == Judge::kForestAndNetwork;
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
      std::min(a.evidence.score, b.evidence.score) >= options.initiation.new_person;
  const float limit_m =
      both_people ? options.classification.leaning_m : options.classification.stacked_m;
  return std::hypot(apart_m.x(), apart_m.z()) < limit_m ||
         IsOneAbove(scene.grid, of_a, of_b, options.candidates.occlusion);
}

bool MayBePartsOfOne(const Scene& scene, const PeopleOptions& options, const Detection& a,
                     const Detection& b, bool stacked) {
  const auto [less, more] = std::minmax(a.evidence.score, b.evidence.score);
  const double person = options.initiation.new_person;
  if (stacked && less >= person) return true;
  return std::max(a.age, b.age) <= options.initiation.early_age && more >= person &&
         MeetAlongRim(scene, a.candidate, b.candidate, options.classification);
}

bool MayBeTwo(const Detection& whole, const ClassificationOptions& options) {
  return whole.age <= options.mature_age ||
         whole.candidate.region.area_m2 > options.grown_share * whole.prior.full_m2;
}

void CropToBody(const JointTargets& targets, const DepthFrame& frame, const Scene& scene,
                const ClassificationOptions& options, Detection& detection) {
  constexpr size_t kAllBones = recon::kJointCount - 1;
  const auto bones = ConnectBones(targets, detection.evidence, options.max_bone);
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

std::vector<Detection> ClassifyCandidates(const Classifying& with,
                                          std::vector<Candidate> candidates,
                                          std::vector<Decision>& decided) {
  std::vector<Detection> detections = ClassifyEach(with, std::move(candidates));
  // From above the shape says all that can be said of who belongs together.
  if (with.options.candidates.overhead) return detections;
  MergeParts(with, TryAsOne, detections, decided);
  std::vector<Detection> result;
  for (Detection& detection : detections) {
    std::vector<Detection> pieces = CutAtHeads(with, detection, decided);
    if (pieces.empty()) {
      result.push_back(std::move(detection));
    } else {
      std::move(pieces.begin(), pieces.end(), std::back_inserter(result));
    }
  }
  if (with.classifier.network == nullptr) return result;
  ParallelFor(result.size(), with.options.threads, [&](size_t i) { WeighPose(with, result[i]); });
  if (!with.scene.fresh) return result;
  const InitiationOptions& initiation = with.options.initiation;
  if (!IsAnybodyFound(result, initiation)) LookAgainAroundHeads(with, result, decided);
  if (!IsAnybodyFound(result, initiation)) LookAgainOverEdges(with, result, decided);
  MergeParts(with, TryAsSamePose, result, decided);
  return result;
}

}  // namespace ossa::people
