#include "recon/methods/reconstruct_sequence.h"

#include <fmt/format.h>

#include <map>

#include "depth/base/error.h"
#include "recon/methods/methods_internal.h"
#include "recon/models/learned_models.h"
#include "recon/orientation.h"

namespace ossa::recon {
namespace {

// What a method has moved farther is no longer where it was measured, and not tracked: more than
// any sensor's systematic error, which is taken off. By hand.
constexpr double kMeasured_m = 0.15;

BodyRecord Reconstructed(const BodyRecord& body, const TrackedPosture& observed,
                         const ReconstructedPosture& made) {
  const JointOrientations orientations =
      made.orientation ? *made.orientation : ComputeOrientations(made.posture);
  BodyRecord out;
  out.id = body.id;
  for (size_t i = 0; i < kJointCount; ++i) {
    JointRecord joint;
    joint.position_m = made.posture.position_m[i];
    const bool tracked = observed.state[i] == TrackingState::kTracked &&
                         made.reliability[i] > 0.5 &&
                         (joint.position_m - observed.posture.position_m[i]).norm() < kMeasured_m;
    joint.state = tracked ? TrackingState::kTracked : TrackingState::kInferred;
    joint.confidence = observed.confidence[i];
    joint.reliability = made.reliability[i];
    joint.orientation = orientations[i];
    out.joints[i] = joint;
  }
  return out;
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

std::unique_ptr<Reconstructor> MethodFor(int person, const ReconstructorOptions& options,
                                         const BoneLengthsById& bones) {
  const auto known = bones.find(person);
  if (known == bones.end()) return MakeReconstructor(options);
  ReconstructorOptions with = options;
  with.bones_m = known->second;
  return MakeReconstructor(with);
}

/// As ReconstructSequence. `measured`, if given: bones as the methods tell them in the end.
SkeletonSequence Run(const SkeletonSequence& sequence, ReconstructorOptions options,
                     const std::function<bool(size_t)>& progress, const BoneLengthsById& bones,
                     BoneLengthsById* measured) {
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
      const auto now =
          person.method->Step({observed, frame.time_s, nullptr, body.bones_m, frame.floor});
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
                                     const BoneLengthsById& bones) {
  return Run(sequence, options, progress, bones, nullptr);
}

BoneLengthsById MeasureBones(const SkeletonSequence& sequence, const ReconstructorOptions& options,
                             const std::function<bool(size_t)>& progress) {
  BoneLengthsById bones;
  if (RequireMethod(options.method).keeps_bones) Run(sequence, options, progress, {}, &bones);
  return bones;
}

}  // namespace ossa::recon
