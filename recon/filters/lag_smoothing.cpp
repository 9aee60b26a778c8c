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

// By hand: after a longer absence a joint is elsewhere.
constexpr double kGap_s = 0.25;
constexpr double kWidest = 3.0;  // standard deviations; what lies beyond weighs 1 % and less

/// Whether a joint went on from one frame to the next.
bool GoesOn(const TimedPosture& from, const TimedPosture& to, size_t joint) {
  const double step_s = to.time_s - from.time_s;
  return from.present[joint] && to.present[joint] && step_s > 0.0 && step_s <= kGap_s;
}

/// Two frames, one on either side of the one that is smoothed, and what they say of it.
struct Pair {
  const TimedPosture *before, *after;
  double share_before;  // of the line between them: the frame's time lies so
  double weight;        // against the frame's own 1
};

/// The nearest frame of another time, back or ahead; none where the way ends before. Loggers that
/// ask faster than sensors answer say a time twice.
std::optional<size_t> FindOtherTime(std::span<const TimedPosture> way, size_t from, bool ahead) {
  for (size_t at = from; ahead ? at + 1 < way.size() : at > 0;) {
    at = ahead ? at + 1 : at - 1;
    if (way[at].time_s != way[from].time_s) return at;
  }
  return std::nullopt;
}

std::vector<Pair> PairsAround(std::span<const TimedPosture> way, size_t at, size_t joint,
                              const LagOptions& options) {
  std::vector<Pair> pairs;
  const TimedPosture& own = way[at];
  const auto most = options.frames == kWholeRecording ? way.size() : size_t(options.frames);
  const auto square = [](double x) { return x * x; };
  for (size_t k = 1, first = at, last = at; k <= most; ++k) {
    const auto earlier = FindOtherTime(way, first, false), later = FindOtherTime(way, last, true);
    if (!earlier || !later) break;
    const TimedPosture &before = way[*earlier], &after = way[*later];
    if (!GoesOn(before, way[first], joint) || !GoesOn(way[last], after, joint)) break;
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

/// The mean of turns that are near each other: of their quaternions, signs alike.
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

/// The turn with its bone, wherever in the bone's own axes that lies, along the smoothed one.
Eigen::Quaterniond AlongBone(const Eigen::Quaterniond& turn, const Eigen::Quaterniond& own,
                             const Eigen::Vector3d& own_bone_m, const Eigen::Vector3d& bone_m) {
  constexpr double kLeast_m = 1e-6;  // by convention: shorter bones have no direction
  if (own_bone_m.norm() < kLeast_m || bone_m.norm() < kLeast_m) return turn;
  return (SmallestTurn(turn * (own.conjugate() * own_bone_m), bone_m) * turn).normalized();
}

/// A person's way through a recording, and where each of its postures is written.
struct Way {
  std::vector<TimedPosture> postures;
  std::vector<BodyRecord*> bodies;
};

std::map<int, Way> CollectPaths(SkeletonSequence& sequence) {
  std::map<int, Way> ways;
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
      ways[body.id].postures.push_back(one);
      ways[body.id].bodies.push_back(&body);
    }
  }
  return ways;
}

}  // namespace

LagOptions LagOptions::Of(int frames, bool keeps_bones) {
  LagOptions options;
  options.frames = frames;
  options.keeps_bones = keeps_bones;
  return options;
}

TimedPosture SmoothedAt(std::span<const TimedPosture> way, size_t at, const LagOptions& options) {
  const TimedPosture& own = way[at];
  TimedPosture smoothed = own;
  bool is_smoothed = false;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto pairs = PairsAround(way, at, j, options);
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
  for (auto& [id, way] : CollectPaths(out)) {
    for (size_t f = 0; f < way.postures.size(); ++f) {
      const TimedPosture smoothed = SmoothedAt(way.postures, f, options);
      for (size_t j = 0; j < kJointCount; ++j) {
        if (!smoothed.present[j]) continue;
        way.bodies[f]->joints[j]->position_m = smoothed.posture.position_m[j];
        auto& turn = way.bodies[f]->joints[j]->orientation;
        if (turn) turn = smoothed.orientation[j];
      }
    }
  }
  return out;
}

}  // namespace ossa::recon
