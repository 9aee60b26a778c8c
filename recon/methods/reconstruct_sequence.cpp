#include "recon/methods/reconstruct_sequence.h"

#include <fmt/format.h>

#include <limits>
#include <map>

#include "depth/base/error.h"
#include "recon/methods/methods_internal.h"
#include "recon/models/learned_models.h"
#include "recon/orientation.h"

namespace ossa::recon {
namespace {

// A joint moved farther than this by a method is not at its observation and not tracked: more than
// any sensor's systematic error. By hand.
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

// People who return after this under the same id are measured again.
constexpr double kForgotten_s = 60.0;

/// A person's reconstructor, and the index of the last posture in the result, which may be revised.
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

/// The people of a recording, and the frames reconstructed so far.
class SequenceRun {
 public:
  SequenceRun(const ReconstructorOptions& options, const BoneLengthsById& bones)
      : options_(options), bones_(bones) {}

  void Add(const SkeletonFrame& frame) {
    Forget(frame.time_s - kForgotten_s);
    SkeletonFrame made = frame;
    made.bodies.clear();
    for (const BodyRecord& body : frame.bodies) {
      made.bodies.push_back(Step(frame, body, made.bodies.size()));
    }
    frames_.push_back(std::move(made));
  }
  /// The methods' final estimates of bone lengths.
  BoneLengthsById Bones() {
    Forget(std::numeric_limits<double>::infinity());
    return measured_;
  }
  std::vector<SkeletonFrame>& frames() { return frames_; }

 private:
  /// Drops people last seen before `time_s`; their bone lengths are kept.
  void Forget(double time_s) {
    std::erase_if(people_, [&](const auto& entry) {
      const Follower& person = entry.second;
      if (!(person.seen_s < time_s)) return false;
      const auto lengths_m = person.method->Bones();
      if (lengths_m) measured_[entry.first] = *lengths_m;
      return true;
    });
  }
  /// Reconstructs one person in the current frame; `place` is the body's index in the result.
  BodyRecord Step(const SkeletonFrame& frame, const BodyRecord& body, size_t place) {
    Follower& person = people_[body.id];
    if (!person.method) person.method = MethodFor(body.id, options_, bones_);
    const TrackedPosture observed = ToTrackedPosture(body);
    const auto now =
        person.method->Step({observed, frame.time_s, nullptr, body.bones_m, frame.floor});
    if (const auto revised = person.method->Revised()) {
      BodyRecord& written = frames_[person.frame].bodies[person.body];
      written = Reconstructed(written, person.observed, *revised);
    }
    person.observed = observed;
    person.seen_s = frame.time_s;
    person.frame = frames_.size();
    person.body = place;
    return Reconstructed(body, observed, now);
  }

  const ReconstructorOptions& options_;
  const BoneLengthsById& bones_;
  std::map<int, Follower> people_;
  BoneLengthsById measured_;
  std::vector<SkeletonFrame> frames_;
};

void ExpectEachBodyOnce(const SkeletonFrame& frame, const std::string& source) {
  const auto id = RepeatedBody(frame);
  if (!id) return;
  throw InputError(fmt::format("{}: frame {}: expected each body once, found two of id {}", source,
                               frame.frame, *id));
}

/// As ReconstructSequence. `measured`, if given, receives the final estimates of bone lengths.
SkeletonSequence Run(const SkeletonSequence& sequence, ReconstructorOptions options,
                     const std::function<bool(size_t)>& progress, const BoneLengthsById& bones,
                     BoneLengthsById* measured) {
  options.learned = LoadLearned(options);  // read once, not for each person
  MakeReconstructor(options);              // validate before any work
  SequenceRun run(options, bones);
  for (const SkeletonFrame& frame : sequence.frames) {
    ExpectEachBodyOnce(frame, sequence.source);
    run.Add(frame);
    if (progress && !progress(run.frames().size())) break;
  }
  if (measured != nullptr) *measured = run.Bones();
  SkeletonSequence out;
  out.source = sequence.source;
  out.frames = std::move(run.frames());
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
