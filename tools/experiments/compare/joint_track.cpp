#include "tools/experiments/compare/joint_track.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "depth/base/statistics.h"
#include "tools/experiments/compare/absent_frames.h"
#include "tools/experiments/compare/assign_bodies.h"
#include "tools/experiments/compare/clock_offset.h"
#include "tools/experiments/compare/rigid_transform.h"

namespace ossa::tools {
namespace {

using recon::BodyRecord;
using recon::SkeletonFrame;
using recon::SkeletonSequence;

// Constants: chosen by hand unless stated otherwise.

constexpr double kLongestGap_s = 0.2;  // truth is not interpolated across more
constexpr double kSameTime_s = 2e-3;   // nearer than this, a time is the same time

double MedianStep_s(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 1.0 / 30.0;
  return Median(std::move(steps));
}

std::vector<SkeletonFrame> InOrder(std::vector<SkeletonFrame> frames) {
  std::stable_sort(
      frames.begin(), frames.end(),
      [](const SkeletonFrame& a, const SkeletonFrame& b) { return a.time_s < b.time_s; });
  return frames;
}

// Every person of a sequence as a track. Frames are sorted by time; of frames with equal times the
// first counts.
std::map<int, JointTrack> CollectTracks(const SkeletonSequence& sequence) {
  std::map<int, JointTrack> tracks;
  for (const SkeletonFrame& frame : InOrder(sequence.frames)) {
    for (const BodyRecord& body : frame.bodies) {
      JointTrack& track = tracks[body.id];
      if (!track.time_s.empty() && track.time_s.back() == frame.time_s) continue;
      track.time_s.push_back(frame.time_s);
      track.postures.push_back(ToSparsePosture(body));
    }
  }
  return tracks;
}

// Removes joints whose state is not_tracked, even if a method has placed them.
std::vector<SkeletonFrame> RemoveUntracked(std::vector<SkeletonFrame> frames) {
  for (SkeletonFrame& frame : frames) {
    for (BodyRecord& body : frame.bodies) {
      for (auto& joint : body.joints) {
        if (joint && joint->state == recon::TrackingState::kNotTracked) joint.reset();
      }
    }
  }
  return frames;
}

// True if any joint is present.
std::vector<double> CollectTimes(const std::map<int, JointTrack>& tracks) {
  std::set<double> times;
  for (const auto& [id, track] : tracks) times.insert(track.time_s.begin(), track.time_s.end());
  return {times.begin(), times.end()};
}

SparsePosture Between(const SparsePosture& a, const SparsePosture& b, double share) {
  SparsePosture between;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    between.present[j] = a.present[j] && b.present[j];
    between.position_m[j] = (1 - share) * a.position_m[j] + share * b.position_m[j];
    between.confidence[j] = std::min(a.confidence[j], b.confidence[j]);
  }
  return between;
}

bool FrameTimesAgree(const JointTrack& truth, const JointTrack& result) {
  const double tolerance_s = 0.25 * MedianStep_s(truth.time_s);
  size_t near = 0;
  for (const double time_s : result.time_s) {
    const auto next = std::lower_bound(truth.time_s.begin(), truth.time_s.end(), time_s);
    const bool after = next != truth.time_s.end() && *next - time_s <= tolerance_s;
    const bool before = next != truth.time_s.begin() && time_s - *(next - 1) <= tolerance_s;
    near += after || before ? 1 : 0;
  }
  // A recording may be a little longer than the truth: one frame in ten may have no counterpart.
  return 10 * near >= 9 * result.time_s.size();
}

void AlignRigidly(PairedTracks& pair) {
  CommonJoints common;
  for (size_t f = 0; f < pair.truth.size(); ++f) common.Add(pair.result[f], pair.truth[f]);
  const auto transform = common.Align();
  if (!transform) return;
  for (SparsePosture& posture : pair.result) posture = Moved(*transform, std::move(posture));
}

void FindOffset(const JointTrack& truth, const JointTrack& result, const PairOptions& options,
                PairedTracks& pair) {
  pair.same_clock = options.time == TimeAlignment::kNone ||
                    (options.time == TimeAlignment::kAuto && FrameTimesAgree(truth, result));
  if (options.time == TimeAlignment::kFixed) {
    pair.offset_s = options.offset_s;
  } else if (!pair.same_clock) {
    pair.offset_s = FindClockOffset_s(truth, result, options.max_offset_s, options.stop);
  }
}

// The main person of a file: the one with the most frames.
const JointTrack* MainTrack(const std::map<int, JointTrack>& tracks) {
  const JointTrack* main = nullptr;
  for (const auto& [id, track] : tracks) {
    if (main == nullptr || track.time_s.size() > main->time_s.size()) main = &track;
  }
  return main;
}

// The only person of a result in all its frames, also those without a body. Of several bodies the
// one with the most frames counts, else the first: an id may change.
JointTrack TrackOfOnePerson(const SkeletonSequence& result) {
  std::map<int, size_t> frames_of;
  for (const SkeletonFrame& frame : result.frames) {
    for (const BodyRecord& body : frame.bodies) ++frames_of[body.id];
  }
  JointTrack only;
  for (const SkeletonFrame& frame : InOrder(result.frames)) {
    if (!only.time_s.empty() && frame.time_s <= only.time_s.back()) continue;
    const auto main = std::max_element(frame.bodies.begin(), frame.bodies.end(),
                                       [&](const BodyRecord& a, const BodyRecord& b) {
                                         return frames_of.at(a.id) < frames_of.at(b.id);
                                       });
    only.time_s.push_back(frame.time_s);
    only.postures.push_back(main == frame.bodies.end() ? SparsePosture{} : ToSparsePosture(*main));
  }
  return only;
}

// One clock offset for all people. Several people are matched by their positions at equal times, so
// clocks are not searched by default; if requested, the people with the most frames are assumed to
// be the same.
PairedTracks AlignClock(const std::map<int, JointTrack>& truths, const SkeletonSequence& result,
                        const PairOptions& options) {
  PairedTracks clock;
  if (result.frames.empty()) return clock;
  if (truths.size() == 1) {
    FindOffset(truths.begin()->second, TrackOfOnePerson(result), options, clock);
    return clock;
  }
  const auto results = CollectTracks(result);
  const JointTrack* main = MainTrack(results);
  if (options.time == TimeAlignment::kAuto || main == nullptr) return clock;
  FindOffset(*MainTrack(truths), *main, options, clock);
  return clock;
}

// Of frames with equal times the first counts.
std::vector<Moment> CollectMoments(const std::map<int, JointTrack>& truths,
                                   const std::vector<SkeletonFrame>& frames) {
  std::vector<Moment> moments;
  for (const SkeletonFrame& frame : frames) {
    if (!moments.empty() && frame.time_s <= moments.back().time_s) continue;
    Moment& moment = moments.emplace_back();
    moment.time_s = frame.time_s;
    for (const auto& [id, track] : truths) moment.truths.push_back(PostureAt(track, frame.time_s));
    for (const BodyRecord& body : frame.bodies) {
      moment.bodies.push_back(ToSparsePosture(body));
      moment.ids.push_back(body.id);
    }
  }
  return moments;
}

void AddMoment(const Moment& moment, std::vector<PairedTracks>& pairs) {
  const auto taken = AssignBodies(moment);
  for (size_t t = 0; t < taken.size(); ++t) {
    if (!moment.truths[t]) continue;
    pairs[t].time_s.push_back(moment.time_s);
    pairs[t].truth.push_back(*moment.truths[t]);
    pairs[t].result.push_back(taken[t]);
  }
}

}  // namespace

SparsePosture ToSparsePosture(const BodyRecord& body) {
  SparsePosture sparse;
  const recon::TrackedPosture tracked = recon::ToTrackedPosture(body);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    sparse.present[j] = body.joints[j] && recon::HasPlace(*body.joints[j]);
    sparse.position_m[j] = tracked.posture.position_m[j];
    sparse.confidence[j] = tracked.confidence[j];
  }
  return sparse;
}

std::optional<SparsePosture> PostureAt(const JointTrack& track, double time_s) {
  const auto& times = track.time_s;
  const auto next = static_cast<size_t>(
      std::lower_bound(times.begin(), times.end(), time_s - kSameTime_s) - times.begin());
  if (next == times.size()) return std::nullopt;
  if (std::abs(times[next] - time_s) <= kSameTime_s) return track.postures[next];
  if (next == 0) return std::nullopt;
  const double step_s = times[next] - times[next - 1];
  if (step_s > kLongestGap_s) return std::nullopt;
  return Between(track.postures[next - 1], track.postures[next],
                 (time_s - times[next - 1]) / step_s);
}

std::vector<PairedTracks> PairUp(const SkeletonSequence& truth, const SkeletonSequence& result,
                                 const PairOptions& options) {
  const auto truths = CollectTracks(truth);
  if (truths.empty()) return {};
  const PairedTracks clock = AlignClock(truths, result, options);
  std::vector<SkeletonFrame> frames = InOrder(result.frames);
  if (options.found_only) frames = RemoveUntracked(std::move(frames));
  for (SkeletonFrame& frame : frames) frame.time_s += clock.offset_s;
  AddAbsentFrames({CollectTimes(truths), kLongestGap_s, clock.same_clock}, &frames);
  std::vector<Moment> moments = CollectMoments(truths, frames);
  if (options.rigid) MoveBodies(FindCommonTransform(moments), moments);
  std::vector<PairedTracks> pairs(truths.size(), clock);
  for (const Moment& moment : moments) AddMoment(moment, pairs);
  for (size_t t = 0; const auto& [id, track] : truths) {
    // A single person needs no matching of ids, which methods with extra bodies would confuse.
    if (truths.size() > 1) pairs[t].name = "body " + std::to_string(id);
    if (options.rigid) AlignRigidly(pairs[t]);
    ++t;
  }
  return pairs;
}

}  // namespace ossa::tools
