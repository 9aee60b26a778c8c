#include "recon/methods/best/completion_internal.h"

#include <algorithm>
#include <cmath>

#include "recon/methods/methods_internal.h"

namespace ossa::recon {
namespace {

/// A quarter of the paper's search: doubtful joints are no worse in the ten scenarios of Plantard
/// 2016 (`ossa experiment plantard-2016`), and a frame takes half a millisecond less.
ReconstructorOptions OptionsForCompletion(ReconstructorOptions options) {
  options.local_pca.steps = 8;
  options.local_pca.samples = 60;
  options.bones_m.reset();  // joints have the sensor's bone lengths here
  return options;
}

/// Quality of the sensor's guess of a joint, in [0, 1]: 0 for a joint without one.
double RateGuess(const CompletionInput& input, size_t joint) {
  const TrackedPosture& observed = input.observation.observed;
  if (observed.state[joint] == TrackingState::kNotTracked) return 0.0;
  const double confidence = observed.confidence[joint];
  if (!std::isfinite(confidence)) return 0.0;
  return std::clamp(confidence / input.sensor.fair_confidence, 0.0, 1.0);
}

/// The joint's position with its offset from the parent in `posture`, added to the parent in
/// `target`.
Eigen::Vector3d PropagateAlongChain(const Posture& posture, size_t joint, const Posture& target,
                                    const PreparedPosture& prepared) {
  if (joint == 0) return prepared.in_camera.position_m[0];
  const size_t parent = ParentOf(joint);
  return target.position_m[parent] + posture.position_m[joint] - posture.position_m[parent];
}

/// Length of the chain of bones from a joint up to one of its ancestors, metres.
double MeasureChain_m(const Posture& posture, size_t joint, size_t ancestor) {
  double length_m = 0.0;
  for (; joint != ancestor; joint = ParentOf(joint))
    length_m += (posture.position_m[joint] - posture.position_m[ParentOf(joint)]).norm();
  return length_m;
}

}  // namespace

Completion::Completion(const ReconstructorOptions& options) {
  if (options.prior) {
    prior_.emplace(options.prior);
  } else if (options.database) {
    plantard_ = MakePlantard2016(OptionsForCompletion(options));
  }
}

void Completion::FindMissing(const PreparedPosture& prepared, const SensorTraits& sensor) {
  for (size_t i = 0; i < kJointCount; ++i)
    missing_[i] = !sensor.places_hidden_joints && had_[i] && prepared.present[i] == 0.0;
}

/// Whether a joint that this sensor provides is in doubt. Joints that it never provides (a Kinect's
/// recording without hands) are ignored.
bool Completion::IsInDoubt(const PreparedPosture& prepared, const JointWeights& trust) {
  bool doubt = false;
  for (size_t i = 0; i < kJointCount; ++i) {
    had_[i] = had_[i] || prepared.present[i] > 0.0;
    doubt = doubt || (had_[i] && trust[i] <= TrustOptions().trusted);
  }
  return doubt;
}

Posture Completion::Complete(const CompletionInput& input) {
  const PreparedPosture& prepared = input.prepared;
  Posture target = prepared.in_camera;
  JointWeights trust = input.trust;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (input.filter_corrects[i]) trust[i] = 1.0;
  }
  if (!IsInDoubt(prepared, trust)) {
    if (prior_) prior_->Forget();
    return target;
  }
  const TrustOptions limits;
  const Posture before = input.before.value_or(prepared.in_camera);
  const bool expects = HasExpectation(prepared);
  const Posture expected = expects ? Expect(input) : before;
  JointWeights seen;  // 1: observed position, 0: propagated
  Posture propagated;
  for (size_t i = 0; i < kJointCount; ++i) {
    seen[i] = IsInterpolated(prepared, missing_, i) ? trust[i] / limits.interpolated
                                                    : std::min(1.0, trust[i] / limits.trusted);
    const double fair = expects ? RateGuess(input, i) : 1.0;
    const auto propagate = [&](const Posture& posture) {
      return PropagateAlongChain(posture, i, target, prepared);
    };
    propagated.position_m[i] =
        fair * propagate(before) +
        (1.0 - fair) * (i == 0 ? expected.position_m[i] : propagate(expected));
    target.position_m[i] =
        seen[i] * target.position_m[i] + (1.0 - seen[i]) * propagated.position_m[i];
  }
  StretchToVisibleEnds(seen, propagated, target);
  return target;
}

bool Completion::HasExpectation(const PreparedPosture& prepared) const {
  constexpr int kFewest = 4;  // joints; by hand: fewer do not identify a posture of a database
  const auto seen = std::count(prepared.present.begin(), prepared.present.end(), 1.0);
  return prior_ ? seen > 0 : plantard_ && seen >= kFewest;
}

Posture Completion::Expect(const CompletionInput& input) {
  if (!prior_) return plantard_->Step(input.observation).posture;
  return prior_->Step(input.prepared, input.trust, input.before, input.lengths_m);
}

/// Stretches a limb to its observed end: if a hand is not where the arm predicts it, the missing
/// joints above move with it, in proportion to their distance from the shoulder.
void Completion::StretchToVisibleEnds(const JointWeights& seen, const Posture& propagated,
                                      Posture& target) const {
  constexpr double kLeastChain_m = 1e-3;  // by hand: shares are undefined below
  for (size_t end = 0; end < kJointCount; ++end) {
    if (!IsInLimb(end) || seen[end] == 0.0) continue;
    size_t fixed = ParentOf(end);
    while (IsInLimb(fixed) && seen[fixed] < 1.0) fixed = ParentOf(fixed);
    const double whole_m = MeasureChain_m(propagated, end, fixed);
    if (!(whole_m > kLeastChain_m)) continue;
    const Eigen::Vector3d off_m = target.position_m[end] - propagated.position_m[end];
    for (size_t i = ParentOf(end); i != fixed; i = ParentOf(i)) {
      const double share = MeasureChain_m(propagated, i, fixed) / whole_m;
      if (missing_[i]) target.position_m[i] += (1.0 - seen[i]) * share * off_m;
    }
  }
}

void Completion::Reset() {
  if (plantard_) plantard_->Reset();
  if (prior_) prior_->Forget();
  had_.fill(false);
  missing_.fill(false);
}

}  // namespace ossa::recon
