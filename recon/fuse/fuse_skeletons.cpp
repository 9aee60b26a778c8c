#include "recon/fuse/fuse_skeletons.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "recon/bone_lengths.h"
#include "recon/bone_projection.h"
#include "recon/fuse/associate_bodies_internal.h"
#include "recon/fuse/fuse_joints_internal.h"
#include "recon/fuse/sighting_internal.h"
#include "recon/orientation.h"
#include "recon/placed_joint.h"

namespace ossa::recon {
namespace {

/// The body tracks of one camera, for interpolation at any time.
struct CameraTracks {
  std::vector<BodyTrack> tracks;
  Eigen::Isometry3d camera_0_from_camera;
  double clock_offset_s = 0.0;
};

std::vector<CameraTracks> TakeTracks(std::span<const SkeletonSequence> sequences,
                                     const Extrinsics& cameras, double max_gap_s) {
  std::vector<CameraTracks> all;
  for (size_t k = 0; k < sequences.size(); ++k) {
    all.push_back({CollectBodyTracks(sequences[k], max_gap_s), cameras[k].from_camera_0.inverse(),
                   cameras[k].clock_offset_s});
  }
  return all;
}

/// Time range of a recording, camera 0's clock.
struct TimeSpan {
  double begin_s = 0.0, end_s = 0.0;
};

TimeSpan SpanOf(const SkeletonSequence& sequence, double clock_offset_s) {
  return {sequence.frames.front().time_s + clock_offset_s,
          sequence.frames.back().time_s + clock_offset_s};
}

/// A warning for each camera whose recording does not overlap camera 0's in time: a wrong clock
/// offset would otherwise look like a camera that sees nobody.
std::vector<std::string> WarnOfOtherTimes(std::span<const SkeletonSequence> sequences,
                                          const Extrinsics& cameras) {
  std::vector<std::string> warnings;
  if (sequences.front().frames.empty()) return warnings;
  const TimeSpan first = SpanOf(sequences.front(), 0.0);
  for (size_t k = 1; k < sequences.size(); ++k) {
    if (sequences[k].frames.empty()) continue;
    const TimeSpan other = SpanOf(sequences[k], cameras[k].clock_offset_s);
    if (other.begin_s <= first.end_s && first.begin_s <= other.end_s) continue;
    warnings.push_back(fmt::format(
        "{}: by its clock offset, {:.3f} s, it is from {:.3f} to {:.3f} s, and {} from {:.3f} to "
        "{:.3f} s: it adds nothing",
        sequences[k].source, cameras[k].clock_offset_s, other.begin_s, other.end_s,
        sequences.front().source, first.begin_s, first.end_s));
  }
  return warnings;
}

/// Camera 0's bodies, and the other cameras' bodies at that time. Point formats keep bodies of
/// unseen people: those without a position are left out, because they would become persons of their
/// own.
std::vector<BodySighting> SightingsOf(const SkeletonFrame& frame,
                                      const std::vector<CameraTracks>& cameras) {
  std::vector<BodySighting> sightings;
  for (const BodyRecord& body : frame.bodies) {
    if (!HasPlacedJoint(body)) continue;
    sightings.push_back(MakeSighting(0, body, Eigen::Isometry3d::Identity()));
  }
  for (size_t k = 1; k < cameras.size(); ++k) {
    const double time_s = frame.time_s - cameras[k].clock_offset_s;
    for (const BodyTrack& track : cameras[k].tracks) {
      auto body = BodyAt(track, time_s);
      if (!body || !HasPlacedJoint(*body)) continue;
      sightings.push_back(MakeSighting(k, std::move(*body), cameras[k].camera_0_from_camera));
    }
  }
  return sightings;
}

bool IsComplete(const BodyRecord& body) {
  return std::all_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

Posture PostureOf(const BodyRecord& body) { return ToTrackedPosture(body).posture; }

bool IsWhollyTracked(const BodyRecord& body, size_t bone) {
  const auto tracked = [&body](size_t j) {
    return body.joints[j]->state.value_or(TrackingState::kTracked) == TrackingState::kTracked;
  };
  return tracked(bone) && tracked(ParentOf(bone));
}

/// The median length of each bone of each person, from frames in which both ends are tracked, if
/// there are any.
std::map<int, BoneLengths> MeasureBonesOf(const SkeletonSequence& sequence) {
  std::map<int, BoneLengthEstimator> tracked, all;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      if (!IsComplete(body)) continue;
      const BoneLengths lengths_m = MeasureBoneLengths(PostureOf(body));
      auto& of_all = all.try_emplace(body.id, BoneLengthOptions::ForWholeRecording()).first->second;
      auto& of_tracked =
          tracked.try_emplace(body.id, BoneLengthOptions::ForWholeRecording()).first->second;
      for (size_t j = 1; j < kJointCount; ++j) {
        if (!(lengths_m[j] > 0.0)) continue;
        of_all.Add(j, lengths_m[j]);
        if (IsWhollyTracked(body, j)) of_tracked.Add(j, lengths_m[j]);
      }
    }
  }
  std::map<int, BoneLengths> lengths_m;
  for (const auto& [id, of_all] : all) {
    for (size_t j = 1; j < kJointCount; ++j) {
      const double of_tracked_m = tracked.at(id).length_m(j);
      lengths_m[id][j] = of_tracked_m > 0.0 ? of_tracked_m : of_all.length_m(j);
    }
  }
  return lengths_m;
}

JointWeights WeightsOf(const BodyRecord& body) {
  constexpr double kUnseen = 0.1;  // weight of a joint that is not tracked; by hand
  JointWeights weights;
  for (size_t j = 0; j < kJointCount; ++j) {
    const bool tracked =
        body.joints[j]->state.value_or(TrackingState::kTracked) == TrackingState::kTracked;
    weights[j] = tracked ? 1.0 : kUnseen;
  }
  return weights;
}

void KeepBones(const BoneLengths& lengths_m, BodyRecord& body) {
  const bool known = std::all_of(lengths_m.begin() + 1, lengths_m.end(),
                                 [](double length_m) { return length_m > 0.0; });
  if (!known || !IsComplete(body)) return;
  const Posture kept = WithBoneLengths(PostureOf(body), lengths_m, WeightsOf(body));
  for (size_t j = 0; j < kJointCount; ++j) body.joints[j]->position_m = kept.position_m[j];
}

void Reorient(BodyRecord& body) {
  const bool any = std::any_of(body.joints.begin(), body.joints.end(),
                               [](const auto& joint) { return joint && joint->orientation; });
  if (!any || !IsComplete(body)) return;
  const JointOrientations turns = ComputeOrientations(PostureOf(body));
  for (size_t j = 0; j < kJointCount; ++j) body.joints[j]->orientation = turns[j];
}

/// Adjusts only people fused from several cameras; others remain as their camera has them.
void FinishBodies(SkeletonSequence& sequence, const std::set<int>& fused, bool keep_bones) {
  const auto lengths_m = keep_bones ? MeasureBonesOf(sequence) : std::map<int, BoneLengths>{};
  for (SkeletonFrame& frame : sequence.frames) {
    for (BodyRecord& body : frame.bodies) {
      if (!fused.contains(body.id)) continue;
      if (const auto of_body = lengths_m.find(body.id); of_body != lengths_m.end()) {
        KeepBones(of_body->second, body);
      }
      Reorient(body);
    }
  }
}

}  // namespace

SkeletonSequence FuseSkeletons(std::span<const SkeletonSequence> sequences,
                               const Extrinsics& cameras, const FuseOptions& options) {
  if (sequences.empty() || sequences.size() != cameras.size()) {
    throw std::invalid_argument("FuseSkeletons: expected a camera for each sequence");
  }
  if (sequences.size() == 1) return sequences.front();
  const std::vector<CameraTracks> tracks = TakeTracks(sequences, cameras, options.max_gap_s);
  SkeletonSequence made = sequences.front();
  made.warnings = WarnOfOtherTimes(sequences, cameras);
  BodyAssociation association;
  std::map<int, JointHistory> history;
  std::set<int> fused;
  for (SkeletonFrame& frame : made.frames) {
    const auto sightings = SightingsOf(frame, tracks);
    frame.bodies.clear();
    for (const SightedPerson& person : association.Update(sightings)) {
      frame.bodies.push_back(
          FuseBody(person.sightings, options.disagreement_m, history[person.id]));
      frame.bodies.back().id = person.id;
      if (person.sightings.size() > 1) fused.insert(person.id);
    }
  }
  FinishBodies(made, fused, options.keep_bones);
  return made;
}

}  // namespace ossa::recon
