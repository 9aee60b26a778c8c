// ossa's own method, the default. Causal; well-observed joints pass nearly unchanged. With a depth
// image the tracker has refined the joints already (recon/refine). A frame passes through these
// stages, each of which is a file in this folder:
//   1. gross_failures: whole-person failures (left and right exchanged, a jump to another body) are
//      undone or waited out; single joints that jump are distrusted until they stay;
//   2. trust: the trust in each joint's observed position;
//   3. completion: doubtful joints are propagated along the chain of bones, towards what a pose
//      prior (prior_completion) or a database predicts;
//   4. posture_filter: one filter per joint, weighted by trust, or one learned for this sensor; a
//      frame later it gives a revised estimate;
//   5. correction: the learned systematic error of the whole posture is subtracted;
//   6. bones: the person's bones, measured by BodySize, get constant lengths.
// sensor_traits describes sensors, and which stages depend on them.
#include <algorithm>

#include "recon/methods/best/bones_internal.h"
#include "recon/methods/best/completion_internal.h"
#include "recon/methods/best/correction_internal.h"
#include "recon/methods/best/gross_failures_internal.h"
#include "recon/methods/best/posture_filter_internal.h"
#include "recon/methods/best/trust_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/models/learned_models.h"

namespace ossa::recon {
namespace {

// By hand: without completion, a doubtful joint enters its filter as a measurement with at most
// twice the variance.
constexpr double kLeastFilterWeight = 0.5;

class Best : public Reconstructor {
 public:
  explicit Best(const ReconstructorOptions& options)
      : options_(options.best),
        known_bones_m_(options.bones_m),
        failures_(options.best.constants.failure_slack_m),
        completion_(options) {
    LinearFilter learned_filter;
    if (const auto learned = LoadLearned(options)) {
      proportions_ = learned->correction.proportions;
      learned_filter = learned->filter;
      if (options_.correct) {
        correction_ =
            Correction(learned->correction, options_.window ? learned->window : WindowCorrection(),
                       options_.constants.posture_share);
      }
    }
    filter_ = PostureFilter(options_.constants, learned_filter);
    ResetBodySize();
  }

  ReconstructedPosture Step(const ReconstructionInput& raw) override {
    ReconstructionInput input = raw;
    sensor_ = ChooseTraits(options_.refined_joints, input.depth != nullptr);
    const double body_trust = options_.repair ? failures_.Repair(input) : 1.0;  // 1.
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) filter_.Restart();
    completion_.FindMissing(prepared, sensor_);

    FrameState frame = Judge(prepared, input, body_trust);               // 2.
    const Posture whole = Complete(prepared, input, frame, body_trust);  // 3.
    const Posture now = Filter(whole, prepared, frame.trust);            // 4.
    const Posture& before = options_.filter ? filter_.before() : whole;
    frame.held = body_trust > 0.0 ? now : prepared.in_camera;
    correction_.Observe(now, frame, prepared.dt_s);  // 5.
    const Posture corrected = correction_.Apply(now, frame);
    size_.Observe(corrected, TrustInBones(prepared, frame.trust), prepared.scale, input.bones_m);
    ReconstructedPosture out = WithBones(corrected, frame);  // 6.
    out.failure = failures_.failure();

    Revise(prepared, before);
    last_ = frame;
    // Compared with the next frame, which has the sensor's errors: hence not the corrected posture.
    failures_.Remember(now, prepared.dt_s);
    person_.Remember(now, prepared);
    return out;
  }

  std::optional<ReconstructedPosture> Revised() const override { return revised_; }

  std::optional<BoneLengths> Bones() const override { return size_.Latest(); }

  void Reset() override {
    person_.Reset();
    failures_ = GrossFailures(options_.constants.failure_slack_m);
    completion_.Reset();
    filter_.Restart();
    correction_.Reset();
    ResetBodySize();
    last_.reset();
    revised_.reset();
  }

 private:
  void ResetBodySize() {
    size_ = BodySize({.as_measured = true});
    size_.Expect(proportions_, options_.constants.expected_share);
    if (known_bones_m_) size_.Know(*known_bones_m_);
  }

  FrameState Judge(const PreparedPosture& prepared, const ReconstructionInput& input,
                   double body_trust) const {
    TrustInputs inputs{body_trust, failures_.joint_trust(), completion_.missing()};
    if (!options_.repair) inputs.jumps.fill(1.0);
    FrameState frame;
    frame.placement = prepared.placement;
    frame.scale = prepared.scale;
    frame.time_s = input.time_s;
    frame.trust = ComputeTrust(prepared, input.observed, sensor_, inputs);
    for (size_t i = 0; i < kJointCount; ++i)
      frame.reliability[i] = std::min(prepared.reliability[i], frame.trust[i]);
    return frame;
  }

  Posture Complete(const PreparedPosture& prepared, const ReconstructionInput& input,
                   const FrameState& frame, double body_trust) {
    const std::optional<Posture>& before = person_.last_in_camera();
    if (body_trust == 0.0 && before) return *before;  // perhaps another person
    if (!options_.complete) return prepared.in_camera;
    JointArray<bool> filter_corrects;
    for (size_t i = 0; i < kJointCount; ++i) filter_corrects[i] = FilterCorrects(prepared, i);
    return completion_.Complete({prepared, input, sensor_, frame.trust, filter_corrects, before,
                                 person_.size().lengths_m()});
  }

  /// Whether the learned filter gets a joint as observed, trusted or not: it has learned this
  /// sensor's gross errors, but not the jumps that are waited out.
  bool FilterCorrects(const PreparedPosture& prepared, size_t joint) const {
    return options_.filter && filter_.UsedInfluence(joint) && prepared.present[joint] > 0.0 &&
           failures_.joint_trust()[joint] > TrustOptions().trusted;
  }

  Posture Filter(const Posture& whole, const PreparedPosture& prepared, const JointWeights& trust) {
    if (failures_.elsewhere()) filter_.Restart();
    if (!options_.filter) return whole;
    FilterMask mask;
    for (size_t i = 0; i < kJointCount; ++i) {
      const bool missing = completion_.missing()[i];
      // A held posture has already been filtered and must not lag behind its parent.
      const bool holds = missing && !completion_.HasExpectation(prepared);
      mask.weights[i] = holds ? 1.0 : std::max(trust[i], kLeastFilterWeight);
      mask.trusted[i] = trust[i] > TrustOptions().trusted;
      mask.observed[i] = !missing;
    }
    return filter_.Step(whole, prepared.placement.yaw_rad, prepared.dt_s, mask);
  }

  ReconstructedPosture WithBones(const Posture& posture, const FrameState& frame) const {
    if (!options_.bones) return {posture, frame.reliability};
    return {
        ImposeBones(posture, size_.lengths_m(), frame, sensor_, options_.constants.limb_firmness),
        frame.reliability};
  }

  /// Revises the previous frame, now that this one is known.
  void Revise(const PreparedPosture& prepared, const Posture& before) {
    revised_.reset();
    if (!last_ || prepared.restarted || !options_.filter) return;
    const Posture& better = failures_.elsewhere() ? last_->held : before;
    revised_ = WithBones(correction_.Apply(better, *last_), *last_);
  }

  BestOptions options_;
  std::optional<BoneLengths> known_bones_m_;
  BoneLengths proportions_{};  // expected bone lengths relative to the standard ones, if learned
  SensorTraits sensor_;        // of the latest frame
  Person person_{ReliabilityOptions{.use_speed = true}};
  GrossFailures failures_;
  Completion completion_;
  PostureFilter filter_;
  Correction correction_;
  BodySize size_;  // of the output: the correction may change bones
  std::optional<FrameState> last_;
  std::optional<ReconstructedPosture> revised_;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeBest(const ReconstructorOptions& options) {
  return std::make_unique<Best>(options);
}

}  // namespace ossa::recon
