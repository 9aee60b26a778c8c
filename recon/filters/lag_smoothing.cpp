#include "recon/filters/lag_smoothing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "recon/bone_projection.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

// By hand: after a longer absence the joint may be anywhere.
constexpr double kGap_s = 0.25;
constexpr double kWidest = 3.0;  // standard deviations; weights beyond are 1 % and less

/// Whether a joint is continuous between two frames.
bool IsContinuous(const TimedPosture& from, const TimedPosture& to, size_t joint) {
  const double step_s = to.time_s - from.time_s;
  return from.present[joint] && to.present[joint] && step_s > 0.0 && step_s <= kGap_s;
}

/// Two frames, one on each side of the smoothed one, with their contribution.
struct Pair {
  const TimedPosture *before, *after;
  double share_before;  // position of the frame's time between theirs
  double weight;        // relative to the frame's own weight of 1
};

/// The nearest frame with a different time, backwards or forwards; none at the end of the track.
/// Loggers that poll faster than the sensor delivers repeat times.
std::optional<size_t> FindOtherTime(std::span<const TimedPosture> track, size_t from, bool ahead) {
  for (size_t at = from; ahead ? at + 1 < track.size() : at > 0;) {
    at = ahead ? at + 1 : at - 1;
    if (track[at].time_s != track[from].time_s) return at;
  }
  return std::nullopt;
}

std::vector<Pair> PairsAround(std::span<const TimedPosture> track, size_t at, size_t joint,
                              const LagOptions& options) {
  std::vector<Pair> pairs;
  const TimedPosture& own = track[at];
  const auto most = options.frames == kWholeRecording ? track.size() : size_t(options.frames);
  const auto square = [](double x) { return x * x; };
  for (size_t k = 1, first = at, last = at; k <= most; ++k) {
    const auto earlier = FindOtherTime(track, first, false),
               later = FindOtherTime(track, last, true);
    if (!earlier || !later) break;
    const TimedPosture &before = track[*earlier], &after = track[*later];
    if (!IsContinuous(before, track[first], joint) || !IsContinuous(track[last], after, joint))
      break;
    first = *earlier;
    last = *later;
    const double back_s = own.time_s - before.time_s, ahead_s = after.time_s - own.time_s;
    const double squares = back_s * ahead_s / square(options.sigma_s);
    if (squares > square(kWidest)) break;
    const double share = ahead_s / (back_s + ahead_s);
    const Eigen::Vector3d middle =
        share * before.posture.position_m[joint] + (1.0 - share) * after.posture.position_m[joint];
    const double unlike =
        (middle - own.posture.position_m[joint]).squaredNorm() / square(options.alike_m);
    pairs.push_back({&before, &after, share, 2.0 * std::exp(-0.5 * (squares + unlike))});
  }
  return pairs;
}

Eigen::Vector3d MeanPosition(const TimedPosture& own, size_t joint,
                             const std::vector<Pair>& pairs) {
  Eigen::Vector3d sum = own.posture.position_m[joint];
  double weights = 1.0;
  for (const Pair& pair : pairs) {
    sum += pair.weight * (pair.share_before * pair.before->posture.position_m[joint] +
                          (1.0 - pair.share_before) * pair.after->posture.position_m[joint]);
    weights += pair.weight;
  }
  return sum / weights;
}

/// Mean of nearby rotations: of their quaternions, with equal signs.
Eigen::Quaterniond MeanTurn(const TimedPosture& own, size_t joint, const std::vector<Pair>& pairs) {
  Eigen::Vector4d sum = own.orientation[joint].coeffs();
  const Eigen::Vector4d first = sum;
  const auto add = [&](const Eigen::Quaterniond& turn, double weight) {
    sum += (turn.coeffs().dot(first) < 0.0 ? -weight : weight) * turn.coeffs();
  };
  for (const Pair& pair : pairs) {
    add(pair.before->orientation[joint], pair.weight * pair.share_before);
    add(pair.after->orientation[joint], pair.weight * (1.0 - pair.share_before));
  }
  return Eigen::Quaterniond(sum).normalized();
}

/// `turn` rotated so that the bone, fixed in the bone's own axes, lies along the smoothed bone.
Eigen::Quaterniond AlongBone(const Eigen::Quaterniond& turn, const Eigen::Quaterniond& own,
                             const Eigen::Vector3d& own_bone_m, const Eigen::Vector3d& bone_m) {
  constexpr double kLeast_m = 1e-6;  // by convention: shorter bones have no direction
  if (own_bone_m.norm() < kLeast_m || bone_m.norm() < kLeast_m) return turn;
  return (SmallestTurn(turn * (own.conjugate() * own_bone_m), bone_m) * turn).normalized();
}

/// A person's track through a recording, and where each of its postures is written.
struct PersonTrack {
  std::vector<TimedPosture> postures;
  std::vector<BodyRecord*> bodies;
};

std::map<int, PersonTrack> CollectPaths(SkeletonSequence& sequence) {
  std::map<int, PersonTrack> tracks;
  for (SkeletonFrame& frame : sequence.frames) {
    for (BodyRecord& body : frame.bodies) {
      TimedPosture one{frame.time_s, {}, {}, {}};
      for (size_t j = 0; j < kJointCount; ++j) {
        one.orientation[j].setIdentity();
        if (!body.joints[j] || !HasPlace(*body.joints[j])) continue;
        one.present[j] = true;
        one.posture.position_m[j] = body.joints[j]->position_m;
        one.orientation[j] = body.joints[j]->orientation.value_or(one.orientation[j]);
      }
      tracks[body.id].postures.push_back(one);
      tracks[body.id].bodies.push_back(&body);
    }
  }
  return tracks;
}

}  // namespace

LagOptions LagOptions::Of(int frames, bool keeps_bones) {
  LagOptions options;
  options.frames = frames;
  options.keeps_bones = keeps_bones;
  return options;
}

TimedPosture SmoothedAt(std::span<const TimedPosture> track, size_t at, const LagOptions& options) {
  const TimedPosture& own = track[at];
  TimedPosture smoothed = own;
  bool is_smoothed = false;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto pairs = PairsAround(track, at, j, options);
    if (pairs.empty()) continue;
    is_smoothed = true;
    smoothed.posture.position_m[j] = MeanPosition(own, j, pairs);
    smoothed.orientation[j] = MeanTurn(own, j, pairs);
  }
  if (!is_smoothed) return own;
  const bool whole = std::all_of(own.present.begin(), own.present.end(), [](bool p) { return p; });
  if (options.keeps_bones && whole) {
    JointWeights alike;
    alike.fill(1.0);
    smoothed.posture = WithBoneLengths(smoothed.posture, MeasureBoneLengths(own.posture), alike);
  }
  const auto bone_m = [](const TimedPosture& of, size_t j) {
    return Eigen::Vector3d(of.posture.position_m[j] - of.posture.position_m[ParentOf(j)]);
  };
  for (size_t j = 1; j < kJointCount; ++j) {
    if (!own.present[j] || !own.present[ParentOf(j)]) continue;
    smoothed.orientation[j] =
        AlongBone(smoothed.orientation[j], own.orientation[j], bone_m(own, j), bone_m(smoothed, j));
  }
  return smoothed;
}

SkeletonSequence SmoothSequence(const SkeletonSequence& sequence, const LagOptions& options) {
  SkeletonSequence out = sequence;
  if (options.frames == 0) return out;
  for (auto& [id, track] : CollectPaths(out)) {
    for (size_t f = 0; f < track.postures.size(); ++f) {
      const TimedPosture smoothed = SmoothedAt(track.postures, f, options);
      for (size_t j = 0; j < kJointCount; ++j) {
        if (!smoothed.present[j]) continue;
        track.bodies[f]->joints[j]->position_m = smoothed.posture.position_m[j];
        auto& turn = track.bodies[f]->joints[j]->orientation;
        if (turn) turn = smoothed.orientation[j];
      }
    }
  }
  return out;
}

}  // namespace ossa::recon
