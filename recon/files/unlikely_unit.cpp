#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "depth/base/statistics.h"
#include "recon/files/unlikely_unit_internal.h"

namespace ossa::recon {
namespace {

// Lengths of thighs, shins and upper arms, which every format has.
std::vector<double> MeasureLimbs(const SkeletonSequence& sequence) {
  constexpr std::array<std::pair<Joint, Joint>, 6> kLimbs = {{
      {Joint::kHipLeft, Joint::kKneeLeft},
      {Joint::kHipRight, Joint::kKneeRight},
      {Joint::kKneeLeft, Joint::kAnkleLeft},
      {Joint::kKneeRight, Joint::kAnkleRight},
      {Joint::kShoulderLeft, Joint::kElbowLeft},
      {Joint::kShoulderRight, Joint::kElbowRight},
  }};
  std::vector<double> lengths;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      for (const auto& [a, b] : kLimbs) {
        if (!body.joints[a] || !body.joints[b]) continue;
        lengths.push_back((body.joints[a]->position_m - body.joints[b]->position_m).norm());
      }
    }
  }
  return lengths;
}

}  // namespace

std::optional<double> MedianLimb(const SkeletonSequence& sequence) {
  std::vector<double> lengths = MeasureLimbs(sequence);
  if (lengths.empty()) return std::nullopt;
  return Median(std::move(lengths));
}

std::string DescribeUnlikelyUnit(const SkeletonSequence& sequence) {
  // Metres, by hand: newborns' limbs are longer than the one, giants' shorter than the other.
  constexpr double kShortest_m = 0.05, kLongest_m = 2.0;
  const auto limb_m = MedianLimb(sequence);
  if (!limb_m || (*limb_m >= kShortest_m && *limb_m <= kLongest_m)) return {};
  return fmt::format(
      "thighs, shins and upper arms are {:.3g} m long, which are no person's: is it in another "
      "unit than it says?",
      *limb_m);
}

std::string DescribeUnlikelyTimes(const SkeletonSequence& sequence) {
  // Seconds, by hand: nobody records a movement so slowly, and no laboratory so fast.
  constexpr double kLongest_s = 2.5, kShortest_s = 2e-4;
  constexpr size_t kEnough = 5;  // by hand: of fewer steps the median may be a pause
  std::vector<double> steps_s;
  for (size_t f = 1; f < sequence.frames.size(); ++f) {
    steps_s.push_back(sequence.frames[f].time_s - sequence.frames[f - 1].time_s);
  }
  if (steps_s.size() < kEnough) return {};
  const double step_s = Median(std::move(steps_s));
  if (step_s == 0.0 || (step_s >= kShortest_s && step_s <= kLongest_s)) return {};
  return fmt::format("its frames are {:.3g} s apart: are its times in another unit than seconds?",
                     step_s);
}

}  // namespace ossa::recon
