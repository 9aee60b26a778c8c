#include "tools/people/frame_rate.h"

#include <algorithm>

namespace ossa::people {

std::optional<double> FrameRate::Update(double time_s) {
  const std::optional<double> before_s = step_s_;
  step_s_.reset();
  if (last_s_ && time_s > *last_s_) step_s_ = time_s - *last_s_;
  last_s_ = time_s;
  if (!step_s_ || !before_s) return std::nullopt;
  return std::min(*step_s_, *before_s);
}

PeopleOptions AdaptToFrameRate(PeopleOptions options, double step_s) {
  constexpr double kTwo = 1.8;          // frames; by hand: their steps vary
  constexpr double kSlowest_s = 1.0;    // by hand: with longer steps each frame is a new scene
  constexpr double kWalking_m_s = 1.4;  // anthropometry: usual walking speed
  const double step = std::min(step_s, kSlowest_s), two_s = kTwo * step;
  InitiationOptions& initiation = options.initiation;
  initiation.unbroken_s = std::max(initiation.unbroken_s, two_s);
  initiation.step_s = std::max(initiation.step_s, two_s);
  initiation.step_m = std::max(initiation.step_m, static_cast<float>(kWalking_m_s * step));
  PredictionOptions& prediction = options.candidates.prediction;
  prediction.max_step_s =
      std::max(prediction.max_step_s, std::min(step, prediction.max_prediction_s));
  options.association.keep_cells_s = std::max(options.association.keep_cells_s, two_s);
  return options;
}

}  // namespace ossa::people
