#include "recon/methods/sequence.h"

#include <algorithm>
#include <cmath>
#include <map>

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

/// A person, and where the posture of the last frame was written: it may be revised.
struct Follower {
  std::unique_ptr<Reconstructor> method;
  TrackedPosture observed;
  size_t frame = 0, body = 0;
};

struct Track {
  std::vector<JointRecord*> joints;  // present ones, in time order
  std::vector<double> time_s;
};

std::unique_ptr<Reconstructor> MethodFor(int person, const ReconstructorOptions& options,
                                         const BonesOfPeople& bones) {
  const auto known = bones.find(person);
  if (known == bones.end()) return MakeReconstructor(options);
  ReconstructorOptions with = options;
  with.bones_m = known->second;
  return MakeReconstructor(with);
}

/// As ReconstructSequence; `people`: what the methods are at the end, by body id.
SkeletonSequence Run(const SkeletonSequence& sequence, const ReconstructorOptions& options,
                     const std::function<bool(size_t)>& progress, const BonesOfPeople& bones,
                     std::map<int, Follower>& people) {
  MakeReconstructor(options);  // complain before any work
  SkeletonSequence out;
  out.source = sequence.source;
  for (const SkeletonFrame& frame : sequence.frames) {
    SkeletonFrame made = frame;
    made.bodies.clear();
    for (const BodyRecord& body : frame.bodies) {
      Follower& person = people[body.id];
      if (!person.method) person.method = MethodFor(body.id, options, bones);
      const TrackedPosture observed = TrackedPostureOf(body);
      const auto now = person.method->Step({observed, frame.time_s, nullptr, body.bones_m});
      if (const auto revised = person.method->Revised()) {
        BodyRecord& written = out.frames[person.frame].bodies[person.body];
        written = Reconstructed(written, person.observed, *revised);
      }
      person.observed = observed;
      person.frame = out.frames.size();
      person.body = made.bodies.size();
      made.bodies.push_back(Reconstructed(body, observed, now));
    }
    out.frames.push_back(std::move(made));
    if (progress && !progress(out.frames.size())) break;
  }
  return out;
}

}  // namespace

SkeletonSequence ReconstructSequence(const SkeletonSequence& sequence,
                                     const ReconstructorOptions& options,
                                     const std::function<bool(size_t)>& progress,
                                     const BonesOfPeople& bones) {
  std::map<int, Follower> people;
  return Run(sequence, options, progress, bones, people);
}

BonesOfPeople MeasureBones(const SkeletonSequence& sequence, const ReconstructorOptions& options,
                           const std::function<bool(size_t)>& progress) {
  BonesOfPeople bones;
  if (!KeepsBones(options.method)) return bones;
  std::map<int, Follower> people;
  Run(sequence, options, progress, {}, people);
  for (const auto& [id, person] : people) {
    if (const auto lengths_m = person.method->Bones()) bones[id] = *lengths_m;
  }
  return bones;
}

SkeletonSequence ButterworthSequence(const SkeletonSequence& sequence, double cutoff_hz) {
  SkeletonSequence out = sequence;
  std::map<std::pair<int, size_t>, Track> tracks;
  for (SkeletonFrame& frame : out.frames) {
    for (BodyRecord& body : frame.bodies) {
      for (size_t i = 0; i < kJointCount; ++i) {
        if (!body.joints[i]) continue;
        Track& track = tracks[{body.id, i}];
        track.joints.push_back(&*body.joints[i]);
        track.time_s.push_back(frame.time_s);
      }
    }
  }
  for (auto& [key, track] : tracks) {
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
