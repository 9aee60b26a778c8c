#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "recon/fuse/sighting_internal.h"
#include "recon/time_step.h"

namespace ossa::recon {
namespace {

template <typename T, typename Mix>
std::optional<T> Both(const std::optional<T>& a, const std::optional<T>& b, const Mix& mix) {
  if (!a || !b) return std::nullopt;
  return mix(*a, *b);
}

/// Linear interpolation; share 0: a, 1: b.
JointRecord Between(const JointRecord& a, const JointRecord& b, double share) {
  const auto lesser = [](const auto& x, const auto& y) { return std::min(x, y); };
  JointRecord joint;
  joint.position_m = (1.0 - share) * a.position_m + share * b.position_m;
  joint.state = Both(a.state, b.state, lesser);
  joint.confidence = Both(a.confidence, b.confidence, lesser);
  joint.reliability = Both(a.reliability, b.reliability, lesser);
  joint.visible = Both(a.visible, b.visible, lesser);
  joint.orientation = Both(a.orientation, b.orientation,
                           [share](const auto& x, const auto& y) { return x.slerp(share, y); });
  joint.sigma_m = Both(a.sigma_m, b.sigma_m,
                       [](const auto& x, const auto& y) { return Eigen::Vector3d(x.cwiseMax(y)); });
  return joint;
}

BodyRecord BetweenBodies(const BodyRecord& a, const BodyRecord& b, double share) {
  BodyRecord body;
  body.id = a.id;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (a.joints[j] && b.joints[j]) body.joints[j] = Between(*a.joints[j], *b.joints[j], share);
  }
  body.bones_m = share < 0.5 ? a.bones_m : b.bones_m;
  return body;
}

double ConfidenceOf(const JointRecord& joint) {
  constexpr double kInferred = 0.5;  // default confidence of an inferred joint: by convention
  const bool tracked = joint.state.value_or(TrackingState::kTracked) == TrackingState::kTracked;
  return joint.confidence.value_or(tracked ? 1.0 : kInferred);
}

Eigen::Matrix3d CovarianceOf(const JointRecord& in_camera) {
  // Standard deviations across and along the ray. Their ratio, and the division of the variance by
  // confidence and reliability, were chosen on six rendered clips by `ossa render --sequence
  // --cameras 2 --split test --seed 101` to 106; docs/several_cameras.md reports measurements on
  // others.
  constexpr double kAcross_m = 0.02, kAlong_m = 0.03;
  constexpr double kLeastTrust = 0.05, kLeastSigma_m = 1e-3;  // share; bounds
  if (in_camera.sigma_m) {
    return in_camera.sigma_m->cwiseMax(kLeastSigma_m).cwiseAbs2().asDiagonal();
  }
  const Eigen::Vector3d ray = in_camera.position_m.normalized();
  const double trust = std::max(kLeastTrust, ConfidenceOf(in_camera)) *
                       std::max(kLeastTrust, in_camera.reliability.value_or(1.0));
  const Eigen::Matrix3d along = ray * ray.transpose();
  return (kAcross_m * kAcross_m * (Eigen::Matrix3d::Identity() - along) +
          kAlong_m * kAlong_m * along) /
         trust;
}

bool IsTracked(const JointRecord& joint) {
  return joint.state.value_or(TrackingState::kTracked) == TrackingState::kTracked &&
         HasPlace(joint);
}

double MeanDistanceOf(const BodyRecord& a, const BodyRecord& b, bool (*counts)(const JointRecord&),
                      int least) {
  double sum_m = 0.0;
  int joints = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!a.joints[j] || !b.joints[j] || !counts(*a.joints[j]) || !counts(*b.joints[j])) continue;
    sum_m += (a.joints[j]->position_m - b.joints[j]->position_m).norm();
    ++joints;
  }
  return joints < least ? std::numeric_limits<double>::infinity() : sum_m / joints;
}

}  // namespace

std::vector<BodyTrack> CollectBodyTracks(const SkeletonSequence& sequence, double max_gap_s) {
  std::map<int, BodyTrack> by_id;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      BodyTrack& track = by_id[body.id];
      track.id = body.id;
      track.time_s.push_back(frame.time_s);
      track.bodies.push_back(&body);
    }
  }
  std::vector<BodyTrack> tracks;
  for (auto& [id, track] : by_id) {
    track.max_gap_s = BridgedGap_s(sequence, max_gap_s);
    tracks.push_back(std::move(track));
  }
  return tracks;
}

std::optional<BodyRecord> BodyAt(const BodyTrack& track, double time_s) {
  const auto after = std::lower_bound(track.time_s.begin(), track.time_s.end(), time_s);
  const auto next = static_cast<size_t>(after - track.time_s.begin());
  const bool has_next = next<track.bodies.size(), has_last = next> 0;
  const double to_next_s = has_next ? *after - time_s : track.max_gap_s;
  const double to_last_s = has_last ? time_s - track.time_s[next - 1] : track.max_gap_s;
  if (to_next_s == 0.0) return *track.bodies[next];
  if (has_next && has_last && to_next_s + to_last_s <= track.max_gap_s) {
    const double share = to_last_s / (to_last_s + to_next_s);
    return BetweenBodies(*track.bodies[next - 1], *track.bodies[next], share);
  }
  constexpr double kSameMoment_s = 0.005;  // by hand
  if (has_last && to_last_s <= kSameMoment_s) return *track.bodies[next - 1];
  if (has_next && to_next_s <= kSameMoment_s) return *track.bodies[next];
  return std::nullopt;
}

BodySighting MakeSighting(size_t camera, BodyRecord body,
                          const Eigen::Isometry3d& camera_0_from_camera) {
  BodySighting sighting{camera, std::move(body), {}};
  const Eigen::Matrix3d turn = camera_0_from_camera.linear();
  for (size_t j = 0; j < kJointCount; ++j) {
    sighting.covariance_m2[j].setIdentity();
    auto& joint = sighting.body.joints[j];
    if (!joint) continue;
    sighting.covariance_m2[j] = turn * CovarianceOf(*joint) * turn.transpose();
    joint->position_m = camera_0_from_camera * joint->position_m;
    if (joint->orientation) joint->orientation = Eigen::Quaterniond(turn) * *joint->orientation;
  }
  return sighting;
}

double MeanDistance_m(const BodyRecord& a, const BodyRecord& b) {
  constexpr int kLeastTracked = 3;  // by hand
  const double tracked_m = MeanDistanceOf(a, b, IsTracked, kLeastTracked);
  return tracked_m < std::numeric_limits<double>::infinity() ? tracked_m
                                                             : MeanDistanceOf(a, b, HasPlace, 1);
}

}  // namespace ossa::recon
