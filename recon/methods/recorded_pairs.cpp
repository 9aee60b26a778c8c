#include "recon/methods/recorded_pairs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "recon/methods/prepared_posture_internal.h"

namespace ossa::recon {
namespace {

// Constants: by hand.

constexpr double kSameTime_s = 0.02;
// Frames farther apart are not interpolated.
constexpr double kLongestStep_s = 0.1;
// Larger offsets belong to another limb and teach nothing.
constexpr double kFarthestResidual_m = 0.5;

/// The truth at one time, between two frames (both the same for a single frame). Empty: unknown.
struct TruthSample {
  const SkeletonFrame* before = nullptr;
  const SkeletonFrame* after = nullptr;
  double share = 0.0;  // interpolation weight from `before` to `after`
};

/// Pairs frames by number. Empty if numbers and times are inconsistent: recordings of two rates
/// share all numbers, but only the first frames coincide. Clocks may drift if the recordings have
/// the same frames.
std::vector<TruthSample> ByNumber(const SkeletonSequence& observed, const SkeletonSequence& truth) {
  constexpr double kDrift_s = 0.5;
  std::map<int64_t, const SkeletonFrame*> numbered;
  for (const SkeletonFrame& frame : truth.frames) numbered[frame.frame] = &frame;
  std::vector<TruthSample> samples(observed.frames.size());
  size_t same = 0, drifted = 0;
  for (size_t f = 0; f < samples.size(); ++f) {
    const auto found = numbered.find(observed.frames[f].frame);
    if (found == numbered.end()) continue;
    const double apart_s = std::abs(found->second->time_s - observed.frames[f].time_s);
    same += apart_s <= kSameTime_s ? 1 : 0;
    drifted += apart_s < kDrift_s ? 1 : 0;
    if (apart_s < kDrift_s) samples[f] = {found->second, found->second, 0.0};
  }
  const size_t all = samples.size();
  const bool as_many = numbered.size() == all && truth.frames.size() == all;
  if (10 * same >= 9 * all || (as_many && drifted == all)) return samples;
  return {};
}

std::vector<TruthSample> ByTime(const SkeletonSequence& observed, const SkeletonSequence& truth) {
  std::map<double, const SkeletonFrame*> timed;
  for (const SkeletonFrame& frame : truth.frames) timed[frame.time_s] = &frame;
  std::vector<TruthSample> samples;
  for (const SkeletonFrame& frame : observed.frames) {
    TruthSample& sample = samples.emplace_back();
    const auto after = timed.lower_bound(frame.time_s);
    if (after != timed.end() && after->first <= frame.time_s + kSameTime_s)
      sample = {after->second, after->second, 0.0};
    if (after == timed.begin() || (sample.after && after->first == frame.time_s)) continue;
    const auto before = std::prev(after);
    if (after != timed.end() && after->first - before->first <= kLongestStep_s) {
      sample = {before->second, after->second,
                (frame.time_s - before->first) / (after->first - before->first)};
    } else if (before->first >= frame.time_s - kSameTime_s) {
      sample = {before->second, before->second, 0.0};
    }
  }
  return samples;
}

const JointRecord* JointOf(const SkeletonFrame& frame, int id, size_t joint) {
  const BodyRecord* of = frame.bodies.empty() ? nullptr : &frame.bodies.front();
  for (const BodyRecord& body : frame.bodies) {
    if (body.id == id) of = &body;
  }
  if (of == nullptr || !of->joints[joint]) return nullptr;
  const JointRecord& record = *of->joints[joint];
  return HasPlace(record) ? &record : nullptr;
}

std::optional<Eigen::Vector3d> TrueJoint(const TruthSample& sample, int id, size_t joint) {
  if (sample.before == nullptr) return std::nullopt;
  const JointRecord* before = JointOf(*sample.before, id, joint);
  const JointRecord* after = JointOf(*sample.after, id, joint);
  if (before == nullptr || after == nullptr) return std::nullopt;
  return Eigen::Vector3d(before->position_m +
                         sample.share * (after->position_m - before->position_m));
}

/// The pair of observation and truth of a body in one frame; none if too few joints are known.
std::optional<PosturePair> MakePair(const PreparedPosture& prepared, const TruthSample& sample,
                                    int id) {
  constexpr double kFewest = 4.0;  // joints, weights of 1
  Posture truth_in_camera = prepared.in_camera;
  PosturePair pair;
  double known = 0.0;
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto p = prepared.present[i] > 0.0 ? TrueJoint(sample, id, i) : std::nullopt;
    if (!p) continue;
    const double off_m = (*p - prepared.in_camera.position_m[i]).norm();
    pair.worst_m = std::max(pair.worst_m, off_m);
    if (!(off_m < kFarthestResidual_m)) continue;
    truth_in_camera.position_m[i] = *p;
    pair.known[i] = 1.0;
    known += 1.0;
  }
  if (known < kFewest) return std::nullopt;
  pair.observed = prepared.scaled;
  pair.placement = prepared.placement;
  pair.scale = prepared.scale;
  const Posture true_scaled =
      Scaled(Normalised(truth_in_camera, prepared.placement), 1.0 / prepared.scale);
  for (size_t i = 0; i < kJointCount; ++i) {
    pair.residual.position_m[i] = true_scaled.position_m[i] - prepared.scaled.position_m[i];
  }
  return pair;
}

/// An observed person, with pairs in order of time.
struct Observed {
  Person person;
  std::vector<PosturePair> pairs;
};

}  // namespace

size_t AddPairs(const SkeletonSequence& observed, const SkeletonSequence& truth,
                std::vector<PosturePair>& pairs, int group) {
  std::vector<TruthSample> samples = ByNumber(observed, truth);
  if (samples.empty()) samples = ByTime(observed, truth);
  std::map<int, Observed> people;
  for (size_t f = 0; f < samples.size(); ++f) {
    const double time_s = observed.frames[f].time_s;
    for (const BodyRecord& body : observed.frames[f].bodies) {
      Observed& one = people[body.id];
      const PreparedPosture prepared =
          one.person.Prepare({ToTrackedPosture(body), time_s, nullptr});
      auto pair = MakePair(prepared, samples[f], body.id);
      if (!pair) continue;
      pair->group = group;
      pair->time_s = time_s;
      one.pairs.push_back(*pair);
    }
  }
  const size_t before = pairs.size();
  for (auto& [id, one] : people) {
    const int clip = static_cast<int>(pairs.size());
    for (PosturePair& pair : one.pairs) {
      pair.clip = clip;
      pairs.push_back(pair);
    }
  }
  return pairs.size() - before;
}

}  // namespace ossa::recon
