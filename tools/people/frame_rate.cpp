#include "tools/people/frame_rate.h"

#include <algorithm>

namespace ossa::people {
namespace {

// How much nearer or farther a person may be a frame later than noise explains, who walked towards
// the camera or away; by more it would be somebody else, or the wall behind. Constants: by hand, on
// recordings of 1 to 10 Hz. At 5 Hz and more the tolerance of 30 Hz is better: 0.
float ComputeSameDepth_m(double step_s, double walked_m) {
  constexpr double kFewInCommon_s = 0.22, kMost_m = 0.35;
  return step_s > kFewInCommon_s ? static_cast<float>(std::min(walked_m, kMost_m)) : 0.0F;
}

}  // namespace

std::optional<double> FrameRate::Update(double time_s) {
  const std::optional<double> before_s = step_s_;
  step_s_.reset();
  if (last_s_ && time_s > *last_s_) step_s_ = time_s - *last_s_;
  last_s_ = time_s;
  if (!step_s_) return std::nullopt;
  return std::min(*step_s_, before_s.value_or(*step_s_));
}

PeopleOptions AdaptToFrameRate(PeopleOptions options, double step_s) {
  constexpr double kTwo = 1.8;          // frames; by hand: their steps vary
  constexpr double kSlowest_s = 1.0;    // by hand: with longer steps each frame is a new scene
  constexpr double kWalking_m_s = 1.4;  // anthropometry: usual walking speed
  const double step = std::min(step_s, kSlowest_s), two_s = kTwo * step;
  const double walked_m = kWalking_m_s * step;
  InitiationOptions& initiation = options.initiation;
  initiation.unbroken_s = std::max(initiation.unbroken_s, two_s);
  initiation.step_s = std::max(initiation.step_s, two_s);
  initiation.step_m = std::max(initiation.step_m, static_cast<float>(walked_m));
  PredictionOptions& prediction = options.candidates.prediction;
  prediction.max_step_s =
      std::max(prediction.max_step_s, std::min(step, prediction.max_prediction_s));
  prediction.same_depth_m = std::max(prediction.same_depth_m, ComputeSameDepth_m(step, walked_m));
  options.association.same_depth_m =
      std::max(options.association.same_depth_m, ComputeSameDepth_m(step, walked_m));
  options.association.keep_cells_s = std::max(options.association.keep_cells_s, two_s);
  for (RestOptions* rest : {&initiation.rest, &prediction.rest})
    rest->lay_s = std::max(rest->lay_s, two_s);
  return options;
}

}  // namespace ossa::people
