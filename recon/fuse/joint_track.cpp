#include <algorithm>
#include <limits>
#include <map>

#include "recon/fuse/joint_track_internal.h"
#include "recon/time_step.h"

namespace ossa::recon {
namespace {

// Copies the tracked joints. False if there are none.
bool TakeTrackedJoints(const BodyRecord& body, SeenJoints& seen) {
  const TrackedPosture tracked = ToTrackedPosture(body);
  seen.position_m = tracked.posture.position_m;
  bool any = false;
  for (size_t j = 0; j < kJointCount; ++j) {
    const bool counts =
        tracked.state[j] == TrackingState::kTracked && tracked.posture.position_m[j].allFinite();
    seen.weight[j] = counts ? tracked.confidence[j] : 0.0;
    any = any || seen.weight[j] > 0.0;
  }
  return any;
}

}  // namespace

std::vector<JointTrack> CollectJointTracks(const SkeletonSequence& sequence) {
  constexpr double kBridged_s = 0.1;  // by hand: three frames of a Kinect
  std::map<int, JointTrack> by_id;
  SeenJoints seen;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      if (!TakeTrackedJoints(body, seen)) continue;
      JointTrack& track = by_id[body.id];
      track.id = body.id;
      track.time_s.push_back(frame.time_s);
      track.seen.push_back(seen);
    }
  }
  std::vector<JointTrack> tracks;
  for (auto& [id, track] : by_id) {
    track.max_gap_s = BridgedGap_s(sequence, kBridged_s);
    tracks.push_back(std::move(track));
  }
  return tracks;
}

bool InterpolateJoints(const JointTrack& track, double time_s, SeenJoints& seen) {
  const auto after = std::lower_bound(track.time_s.begin(), track.time_s.end(), time_s);
  if (after == track.time_s.end()) return false;
  const auto next = static_cast<size_t>(after - track.time_s.begin());
  if (*after == time_s) {
    seen = track.seen[next];
    return true;
  }
  if (next == 0 || *after - track.time_s[next - 1] > track.max_gap_s) return false;
  const SeenJoints& a = track.seen[next - 1];
  const SeenJoints& b = track.seen[next];
  const double share = (time_s - track.time_s[next - 1]) / (*after - track.time_s[next - 1]);
  for (size_t j = 0; j < kJointCount; ++j) {
    seen.position_m[j] = (1.0 - share) * a.position_m[j] + share * b.position_m[j];
    seen.weight[j] = std::min(a.weight[j], b.weight[j]);
  }
  return true;
}

double MeanJointDistance_m(const SeenJoints& a, const SeenJoints& b, int least_joints) {
  double sum = 0.0, weights = 0.0;
  int joints = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    const double weight = std::min(a.weight[j], b.weight[j]);
    if (!(weight > 0.0)) continue;
    sum += weight * (a.position_m[j] - b.position_m[j]).norm();
    weights += weight;
    ++joints;
  }
  return joints < least_joints ? std::numeric_limits<double>::infinity() : sum / weights;
}

}  // namespace ossa::recon
