#include <array>

#include "recon/filters/joint_filters.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/prepared_posture_internal.h"
#include "recon/methods/reach_internal.h"

namespace ossa::recon {

namespace {

/// The baselines: what was seen, completed, through one filter a joint.
template <typename Filter, typename StepFilter>
class FilterReconstructor : public Reconstructor {
 public:
  explicit FilterReconstructor(StepFilter step) : step_(step) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted)
      for (auto& filter : filters_) filter = Filter();
    ReconstructedPosture out{prepared.in_camera, prepared.reliability};
    for (size_t i = 0; i < kJointCount; ++i) {
      out.posture.position_m[i] = step_(filters_[i], prepared, i);
    }
    JointWeights present = prepared.present;
    for (size_t i = 0; i < kJointCount; ++i) present[i] += prepared.interpolated[i];
    // A filter that goes on with a velocity leads away from the joints that are seen.
    if (IsTrunkUnseen(present)) {
      PullIntoReach(out.posture, present, person_.size().lengths_m());
    }
    person_.Remember(out.posture, prepared);
    return out;
  }

  void Reset() override {
    person_.Reset();
    for (auto& filter : filters_) filter = Filter();
  }

 private:
  StepFilter step_;
  Person person_;
  JointArray<Filter> filters_;
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
    return f.Step(p.in_camera.position_m[i], p.dt_s, p.present[i]);
  });
}

}  // namespace ossa::recon
