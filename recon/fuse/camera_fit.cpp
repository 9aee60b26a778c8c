#include "recon/fuse/camera_fit_internal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "recon/fuse/rigid_alignment_internal.h"

namespace ossa::recon {
namespace {

// Constants: by hand.

constexpr size_t kMostMoments = 600;   // compared times, evenly spread; for speed
constexpr double kSameBody_m = 0.6;    // mean distance of joints below which two bodies may be one
constexpr int kLeastJoints = 3;        // common joints needed to compare two bodies
constexpr double kFar_m = 0.15;        // joints so far apart do not agree
constexpr double kUsualJoints = 15.0;  // weight of a body without a counterpart in the other camera
constexpr double kDoubt_s = 0.5;       // common time at which the score is halved
constexpr double kFloorWeight = 0.02;  // m2; weight of the normals as a share of the joints' weight

std::optional<Eigen::Vector3d> MeanFloorNormal(const SkeletonSequence& sequence) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SkeletonFrame& frame : sequence.frames) {
    if (frame.floor) sum += frame.floor->head<3>();
  }
  if (!(sum.norm() > 0.0)) return std::nullopt;
  return sum.normalized();
}

SeenJoints Moved(const SeenJoints& seen, const Eigen::Isometry3d& to_from_from) {
  SeenJoints moved = seen;
  for (auto& position_m : moved.position_m) position_m = to_from_from * position_m;
  return moved;
}

/// A body at one time, and its track.
struct Present {
  size_t track = 0;
  SeenJoints seen;  // in its camera's space
  SeenJoints in_camera_0;
};

std::vector<Present> PresentAt(const std::vector<JointTrack>& tracks, double time_s,
                               const Eigen::Isometry3d& camera_0_from_camera) {
  std::vector<Present> present;
  SeenJoints seen;
  for (size_t k = 0; k < tracks.size(); ++k) {
    if (!InterpolateJoints(tracks[k], time_s, seen)) continue;
    present.push_back({k, seen, Moved(seen, camera_0_from_camera)});
  }
  return present;
}

/// Greedy matching: nearest pairs first, each body once.
std::vector<std::pair<size_t, size_t>> PairBodies(const std::vector<Present>& a,
                                                  const std::vector<Present>& b) {
  std::vector<std::pair<size_t, size_t>> pairs;
  std::vector<bool> a_taken(a.size()), b_taken(b.size());
  while (pairs.size() < std::min(a.size(), b.size())) {
    double nearest_m = kSameBody_m;
    std::optional<std::pair<size_t, size_t>> best;
    for (size_t i = 0; i < a.size(); ++i) {
      for (size_t k = 0; k < b.size(); ++k) {
        if (a_taken[i] || b_taken[k]) continue;
        const double m = MeanJointDistance_m(a[i].in_camera_0, b[k].in_camera_0, kLeastJoints);
        if (!(m < nearest_m)) continue;
        nearest_m = m;
        best = {i, k};
      }
    }
    if (!best) break;
    pairs.push_back(*best);
    a_taken[best->first] = b_taken[best->second] = true;
  }
  return pairs;
}

void AddCommonJoints(const Present& a, const Present& b, CommonJoints& common) {
  for (size_t j = 0; j < kJointCount; ++j) {
    const double weight = std::min(a.seen.weight[j], b.seen.weight[j]);
    if (!(weight > 0.0)) continue;
    common.joints.push_back({a.seen.position_m[j], b.seen.position_m[j], weight, a.track, j});
    common.possible += weight;
  }
}

double Distance_m(const CommonJoint& joint, const Eigen::Isometry3d& camera_0_from_other) {
  return (camera_0_from_other * joint.in_other - joint.in_camera_0).norm();
}

Eigen::Isometry3d AlignRobustly(const CameraPair& pair, const CommonJoints& common,
                                Eigen::Isometry3d camera_0_from_other) {
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    RigidAlignment alignment;
    for (const CommonJoint& joint : common.joints) {
      // Geman and McClure: weights of outliers decay with the fourth power.
      const double off = Distance_m(joint, camera_0_from_other) / kFar_m;
      const double weight = joint.weight / ((1.0 + off * off) * (1.0 + off * off));
      alignment.Add(joint.in_other, joint.in_camera_0, weight);
    }
    if (pair.floor_0 && pair.other_floor) {
      alignment.AddDirection(*pair.other_floor, *pair.floor_0, kFloorWeight * alignment.weight());
    }
    camera_0_from_other = alignment.Solve().to_from_from;
  }
  return camera_0_from_other;
}

double RobustMeanSquare_m2(const CommonJoints& common, const Eigen::Isometry3d& to_from_from) {
  double sum = 0.0, weights = 0.0;
  for (const CommonJoint& joint : common.joints) {
    const double off_m = std::min(Distance_m(joint, to_from_from), kFar_m);
    sum += joint.weight * off_m * off_m;
    weights += joint.weight;
  }
  return weights > 0.0 ? sum / weights : std::numeric_limits<double>::infinity();
}

CameraGuess AlignedAt(const CameraPair& pair, CameraGuess guess, double offset_s) {
  guess.clock_offset_s = offset_s;
  const CommonJoints common = FindCommonJoints(pair, guess);
  if (common.joints.empty()) {
    guess.cost = std::numeric_limits<double>::infinity();
    return guess;
  }
  guess.camera_0_from_other = AlignRobustly(pair, common, guess.camera_0_from_other);
  guess.cost = RobustMeanSquare_m2(common, guess.camera_0_from_other);
  return guess;
}

}  // namespace

CameraPair MakeCameraPair(const SkeletonSequence& camera_0, const SkeletonSequence& other) {
  CameraPair pair;
  pair.camera_0 = CollectJointTracks(camera_0);
  pair.other = CollectJointTracks(other);
  pair.floor_0 = MeanFloorNormal(camera_0);
  pair.other_floor = MeanFloorNormal(other);
  const auto& frames = camera_0.frames;
  const size_t taken = std::min(frames.size(), kMostMoments);
  for (size_t i = 0; i < taken; ++i) {
    pair.moments_s.push_back(frames[i * frames.size() / taken].time_s);
  }
  if (!frames.empty()) pair.length_s = frames.back().time_s - frames.front().time_s;
  return pair;
}

CommonJoints FindCommonJoints(const CameraPair& pair, const CameraGuess& guess) {
  CommonJoints common;
  size_t moments = 0;
  for (const double time_s : pair.moments_s) {
    const auto a = PresentAt(pair.camera_0, time_s, Eigen::Isometry3d::Identity());
    if (a.empty()) continue;
    const auto b = PresentAt(pair.other, time_s - guess.clock_offset_s, guess.camera_0_from_other);
    if (b.empty()) continue;
    ++moments;
    const auto pairs = PairBodies(a, b);
    for (const auto& [i, k] : pairs) AddCommonJoints(a[i], b[k], common);
    common.possible +=
        kUsualJoints * static_cast<double>(std::min(a.size(), b.size()) - pairs.size());
  }
  common.common_s =
      pair.length_s * static_cast<double>(moments) / static_cast<double>(pair.moments_s.size());
  return common;
}

double ScoreGuess(const CommonJoints& common, const CameraGuess& guess) {
  double agreeing = 0.0;
  for (const CommonJoint& joint : common.joints) {
    const double off = std::min(1.0, Distance_m(joint, guess.camera_0_from_other) / kFar_m);
    agreeing += joint.weight * (1.0 - off * off);
  }
  if (!(common.possible > 0.0)) return 0.0;
  return agreeing / common.possible * common.common_s / (common.common_s + kDoubt_s);
}

CameraGuess RefineGuess(const CameraPair& pair, const CameraGuess& guess, double step_s) {
  constexpr int kRounds = 3;
  CameraGuess best = AlignedAt(pair, guess, guess.clock_offset_s);
  for (int round = 0; round < kRounds; ++round) {
    // Offsets whole frames apart, so that interpolation smooths all three alike.
    const double h_s = 2.0 * step_s, middle_s = best.clock_offset_s;
    const double before = AlignedAt(pair, best, middle_s - h_s).cost;
    const double after = AlignedAt(pair, best, middle_s + h_s).cost;
    const double bend = before - 2.0 * best.cost + after;
    if (!(bend > 0.0) || !std::isfinite(bend)) break;
    const double shift_s = std::clamp(0.5 * h_s * (before - after) / bend, -h_s, h_s);
    best = AlignedAt(pair, best, middle_s + shift_s);
  }
  return best;
}

double MeasureMotion_m(const CommonJoints& common) {
  struct Moments {
    double count = 0.0, square = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  };
  std::map<std::pair<size_t, size_t>, Moments> by_joint;
  for (const CommonJoint& joint : common.joints) {
    Moments& m = by_joint[{joint.track, joint.joint}];
    m.count += 1.0;
    m.sum += joint.in_camera_0;
    m.square += joint.in_camera_0.squaredNorm();
  }
  double squares = 0.0, count = 0.0;
  for (const auto& [key, m] : by_joint) {
    squares += m.square - m.sum.squaredNorm() / m.count;
    count += m.count;
  }
  return count > 0.0 ? std::sqrt(std::max(0.0, squares / count)) : 0.0;
}

double MedianDistance_m(const CommonJoints& common, const CameraGuess& guess) {
  if (common.joints.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> off_m;
  for (const CommonJoint& joint : common.joints) {
    off_m.push_back(Distance_m(joint, guess.camera_0_from_other));
  }
  const auto middle = off_m.begin() + static_cast<ptrdiff_t>(off_m.size() / 2);
  std::nth_element(off_m.begin(), middle, off_m.end());
  return *middle;
}

}  // namespace ossa::recon
