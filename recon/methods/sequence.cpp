#include "recon/methods/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "depth/base/error.h"
#include "recon/methods/methods_internal.h"
#include "recon/models/learned_models.h"

namespace ossa::recon {
namespace {

BodyRecord Reconstructed(const BodyRecord& body, const TrackedPosture& observed,
                         const ReconstructedPosture& made) {
  BodyRecord out;
  out.id = body.id;
  for (size_t i = 0; i < kJointCount; ++i) {
    JointRecord joint;
    joint.position_m = made.posture.position_m[i];
    const bool tracked = observed.state[i] == TrackingState::kTracked && made.reliability[i] > 0.5;
    joint.state = tracked ? TrackingState::kTracked : TrackingState::kInferred;
    joint.confidence = observed.confidence[i];
    joint.reliability = made.reliability[i];
    if (made.orientation) joint.orientation = (*made.orientation)[i];
    out.joints[i] = joint;
  }
  return out;
}

/// y = second-order Butterworth low pass of x, bilinear transform, started in its steady state.
std::vector<Eigen::Vector3d> LowPass(const std::vector<Eigen::Vector3d>& x, double ratio) {
  const double k = std::tan(M_PI * ratio), k2 = k * k, root2 = std::sqrt(2.0);
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

// Who comes back later under the same id is measured anew.
constexpr double kForgotten_s = 60.0;

/// A person, and where the posture of the last frame was written: it may be revised.
struct Follower {
  std::unique_ptr<Reconstructor> method;
  TrackedPosture observed;
  double seen_s = 0.0;
  size_t frame = 0, body = 0;
};

/// A joint of a person for as long as it is there.
struct Track {
  std::vector<JointRecord*> joints;  // in time order
  std::vector<double> time_s;
};

double MedianStep_s(const SkeletonSequence& sequence) {
  std::vector<double> steps;
  for (size_t f = 1; f < sequence.frames.size(); ++f)
    steps.push_back(sequence.frames[f].time_s - sequence.frames[f - 1].time_s);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Every joint of every person, anew after an absence of a few frames: what comes after it is not
/// the next sample of what was before.
std::vector<Track> CollectTracks(SkeletonSequence& sequence) {
  constexpr double kGap_frames = 3.5;
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

std::unique_ptr<Reconstructor> MethodFor(int person, const ReconstructorOptions& options,
                                         const BonesOfPeople& bones) {
  const auto known = bones.find(person);
  if (known == bones.end()) return MakeReconstructor(options);
  ReconstructorOptions with = options;
  with.bones_m = known->second;
  return MakeReconstructor(with);
}

/// As ReconstructSequence. `measured`, if given: bones as the methods tell them in the end.
SkeletonSequence Run(const SkeletonSequence& sequence, ReconstructorOptions options,
                     const std::function<bool(size_t)>& progress, const BonesOfPeople& bones,
                     BonesOfPeople* measured) {
  options.learned = LoadLearned(options);  // read once, not for each person
  MakeReconstructor(options);              // complain before any work
  std::map<int, Follower> people;
  const auto tell_bones = [&](int id, const Follower& person) {
    const auto lengths_m = person.method->Bones();
    if (measured != nullptr && lengths_m) (*measured)[id] = *lengths_m;
  };
  SkeletonSequence out;
  out.source = sequence.source;
  for (const SkeletonFrame& frame : sequence.frames) {
    if (const auto id = RepeatedBody(frame)) {
      throw InputError(fmt::format("{}: frame {}: expected each body once, found two of id {}",
                                   sequence.source, frame.frame, *id));
    }
    std::erase_if(people, [&](const auto& entry) {
      const bool gone = frame.time_s - entry.second.seen_s > kForgotten_s;
      if (gone) tell_bones(entry.first, entry.second);
      return gone;
    });
    SkeletonFrame made = frame;
    made.bodies.clear();
    for (const BodyRecord& body : frame.bodies) {
      Follower& person = people[body.id];
      if (!person.method) person.method = MethodFor(body.id, options, bones);
      const TrackedPosture observed = ToTrackedPosture(body);
      const auto now = person.method->Step({observed, frame.time_s, nullptr, body.bones_m});
      if (const auto revised = person.method->Revised()) {
        BodyRecord& written = out.frames[person.frame].bodies[person.body];
        written = Reconstructed(written, person.observed, *revised);
      }
      person.observed = observed;
      person.seen_s = frame.time_s;
      person.frame = out.frames.size();
      person.body = made.bodies.size();
      made.bodies.push_back(Reconstructed(body, observed, now));
    }
    out.frames.push_back(std::move(made));
    if (progress && !progress(out.frames.size())) break;
  }
  for (const auto& [id, person] : people) tell_bones(id, person);
  return out;
}

}  // namespace

SkeletonSequence ReconstructSequence(const SkeletonSequence& sequence,
                                     const ReconstructorOptions& options,
                                     const std::function<bool(size_t)>& progress,
                                     const BonesOfPeople& bones) {
  return Run(sequence, options, progress, bones, nullptr);
}

BonesOfPeople MeasureBones(const SkeletonSequence& sequence, const ReconstructorOptions& options,
                           const std::function<bool(size_t)>& progress) {
  BonesOfPeople bones;
  if (KeepsBones(options.method)) Run(sequence, options, progress, {}, &bones);
  return bones;
}

SkeletonSequence ButterworthSequence(const SkeletonSequence& sequence, double cutoff_hz) {
  SkeletonSequence out = sequence;
  for (Track& track : CollectTracks(out)) {
    const size_t n = track.joints.size();
    if (n < 3 || !(track.time_s.back() > track.time_s.front())) continue;
    const double step_s = (track.time_s.back() - track.time_s.front()) / static_cast<double>(n - 1);
    const double ratio = std::min(cutoff_hz * step_s, 0.45);
    std::vector<Eigen::Vector3d> x;
    for (const JointRecord* joint : track.joints) x.push_back(joint->position_m);
    x = LowPass(x, ratio);
    std::reverse(x.begin(), x.end());
    x = LowPass(x, ratio);
    for (size_t t = 0; t < n; ++t) track.joints[t]->position_m = x[n - 1 - t];
  }
  return out;
}

}  // namespace ossa::recon
