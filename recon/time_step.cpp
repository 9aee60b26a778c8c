#include "recon/time_step.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "depth/base/statistics.h"

namespace ossa::recon {

double MedianStep_s(const SkeletonSequence& sequence) {
  std::vector<double> steps_s;
  for (size_t f = 1; f < sequence.frames.size(); ++f) {
    const double step_s = sequence.frames[f].time_s - sequence.frames[f - 1].time_s;
    if (step_s > 0.0) steps_s.push_back(step_s);
  }
  return steps_s.empty() ? 0.0 : Median(std::move(steps_s));
}

double BridgedGap_s(const SkeletonSequence& sequence, double least_s) {
  constexpr double kSteps = 1.5;  // frames; by hand: one, plus jitter
  return std::max(least_s, kSteps * MedianStep_s(sequence));
}

}  // namespace ossa::recon
