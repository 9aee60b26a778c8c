#include <type_traits>

#include "recon/filters/joint_filters.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/prepared_posture_internal.h"
#include "recon/methods/reach_internal.h"

namespace ossa::recon {

namespace {

/// Whether a filter extrapolates unseen joints.
template <typename Filter>
constexpr bool kExtrapolates = std::is_same_v<Filter, VelocityKalman>;

/// The baselines: observed joints, completed, through one filter per joint.
template <typename Filter, typename StepFilter>
class FilterReconstructor : public Reconstructor {
 public:
  explicit FilterReconstructor(StepFilter step) : step_(step) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) Forget();
    ReconstructedPosture out{prepared.in_camera, prepared.reliability};
    const JointWeights seen = SeenJoints(prepared);
    for (size_t i = 0; i < kJointCount; ++i) {
      was_seen_[i] = was_seen_[i] || seen[i] > 0.0;
      out.posture.position_m[i] = Filtered(prepared, out.posture, i);
    }
    // An extrapolating filter moves unseen joints away from the seen ones; the other filters keep
    // absent joints with seen ones if there is a trunk.
    if (kExtrapolates<Filter> || IsTrunkUnseen(seen)) {
      PullIntoReach(out.posture, seen, person_.size().lengths_m());
    }
    person_.Remember(out.posture, prepared);
    return out;
  }

  void Reset() override {
    person_.Reset();
    Forget();
  }

 private:
  void Forget() {
    filters_.fill(Filter());
    was_seen_.fill(false);
  }

  /// An extrapolating filter has no state before the joint was first seen: until then the joint is
  /// placed relative to its parent, which is already in `made`.
  Eigen::Vector3d Filtered(const PreparedPosture& prepared, const Posture& made, size_t joint) {
    if (!kExtrapolates<Filter> || was_seen_[joint]) return step_(filters_[joint], prepared, joint);
    const Posture& placed = prepared.in_camera;
    if (joint == 0) return placed.position_m[0];
    const size_t parent = ParentOf(joint);
    return made.position_m[parent] + placed.position_m[joint] - placed.position_m[parent];
  }

  StepFilter step_;
  Person person_;
  JointArray<Filter> filters_;
  JointArray<bool> was_seen_{};  // since the last reset
};

template <typename Filter, typename StepFilter>
std::unique_ptr<Reconstructor> MakeFiltered(StepFilter step) {
  return std::make_unique<FilterReconstructor<Filter, StepFilter>>(step);
}

struct NoFilter {};

}  // namespace

std::unique_ptr<Reconstructor> MakeNone(const ReconstructorOptions&) {
  return MakeFiltered<NoFilter>(
      [](NoFilter&, const PreparedPosture& p, size_t i) { return p.in_camera.position_m[i]; });
}

std::unique_ptr<Reconstructor> MakeHolt(const ReconstructorOptions&) {
  return MakeFiltered<HoltFilter>([](HoltFilter& f, const PreparedPosture& p, size_t i) {
    return f.Step(p.in_camera.position_m[i]);
  });
}

std::unique_ptr<Reconstructor> MakeOneEuro(const ReconstructorOptions&) {
  return MakeFiltered<OneEuroFilter>([](OneEuroFilter& f, const PreparedPosture& p, size_t i) {
    return f.Step(p.in_camera.position_m[i], p.dt_s);
  });
}

std::unique_ptr<Reconstructor> MakeKalman(const ReconstructorOptions&) {
  return MakeFiltered<VelocityKalman>([](VelocityKalman& f, const PreparedPosture& p, size_t i) {
    return f.Step(p.in_camera.position_m[i], p.dt_s, p.present[i] + p.interpolated[i]);
  });
}

}  // namespace ossa::recon
