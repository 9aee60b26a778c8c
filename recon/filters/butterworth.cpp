#include "recon/filters/butterworth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "recon/orientation.h"
#include "recon/time_step.h"

namespace ossa::recon {
namespace {

/// Second-order Butterworth low pass by bilinear transform, initialised in the steady state.
std::vector<Eigen::Vector3d> LowPass(const std::vector<Eigen::Vector3d>& x, double ratio) {
  const double k = std::tan(std::numbers::pi * ratio), k2 = k * k, root2 = std::sqrt(2.0);
  const double norm = 1.0 / (1.0 + root2 * k + k2);
  const double b = k2 * norm, a1 = 2.0 * (k2 - 1.0) * norm, a2 = (1.0 - root2 * k + k2) * norm;
  std::vector<Eigen::Vector3d> y(x.size());
  Eigen::Vector3d x1 = x.front(), x2 = x1, y1 = x1, y2 = x1;
  for (size_t t = 0; t < x.size(); ++t) {
    y[t] = b * (x[t] + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1, x1 = x[t];
    y2 = y1, y1 = y[t];
  }
  return y;
}

/// The samples of one joint of one person between absences.
struct Track {
  std::vector<JointRecord*> joints;  // in order of time
  std::vector<double> time_s;
};

/// The tracks of all joints of all people. An absence of a few frames (by hand) starts a new track:
/// the samples around it are not consecutive.
std::vector<Track> CollectTracks(SkeletonSequence& sequence) {
  constexpr double kGap_frames = 3.5;  // by hand
  const double gap_s = kGap_frames * MedianStep_s(sequence);
  std::vector<Track> tracks;
  std::map<std::pair<int, size_t>, size_t> latest;
  for (SkeletonFrame& frame : sequence.frames) {
    for (BodyRecord& body : frame.bodies) {
      for (size_t i = 0; i < kJointCount; ++i) {
        auto& joint = body.joints[i];
        if (joint && !HasPlace(*joint)) joint.reset();
        if (!joint) continue;
        const auto [found, is_new] = latest.try_emplace({body.id, i}, tracks.size());
        if (is_new || frame.time_s - tracks[found->second].time_s.back() > gap_s) {
          found->second = tracks.size();
          tracks.emplace_back();
        }
        tracks[found->second].joints.push_back(&*joint);
        tracks[found->second].time_s.push_back(frame.time_s);
      }
    }
  }
  return tracks;
}

/// Recomputes bone orientations from the filtered joints.
void Orient(BodyRecord& body) {
  Posture posture;
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto& joint = body.joints[i];
    posture.position_m[i] =
        joint ? joint->position_m
              : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const JointOrientations orientations = ComputeOrientations(posture);
  for (size_t i = 0; i < kJointCount; ++i) {
    if (body.joints[i]) body.joints[i]->orientation = orientations[i];
  }
}

}  // namespace

SkeletonSequence ButterworthSequence(const SkeletonSequence& sequence, double cutoff_hz) {
  constexpr double kMostRatio = 0.45;  // of the frame rate; a bound: at 0.5 nothing is filtered
  SkeletonSequence out = sequence;
  for (Track& track : CollectTracks(out)) {
    const size_t n = track.joints.size();
    if (n < 3 || !(track.time_s.back() > track.time_s.front())) continue;
    const double step_s = (track.time_s.back() - track.time_s.front()) / static_cast<double>(n - 1);
    const double ratio = std::min(cutoff_hz * step_s, kMostRatio);
    std::vector<Eigen::Vector3d> x;
    for (const JointRecord* joint : track.joints) x.push_back(joint->position_m);
    x = LowPass(x, ratio);
    std::reverse(x.begin(), x.end());
    x = LowPass(x, ratio);
    for (size_t t = 0; t < n; ++t) track.joints[t]->position_m = x[n - 1 - t];
  }
  for (SkeletonFrame& frame : out.frames) {
    for (BodyRecord& body : frame.bodies) Orient(body);
  }
  return out;
}

}  // namespace ossa::recon
