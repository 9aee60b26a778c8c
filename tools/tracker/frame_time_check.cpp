#include "tools/tracker/frame_time_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "depth/base/statistics.h"
#include "tools/people/options.h"

namespace ossa::tracker {
namespace {

std::string Describe(double step_s) {
  constexpr double kShortest_s = 1e-3;  // by hand: no depth camera has more frames a second
  const double longest_s = people::ReidentifyOptions{}.forget_s;
  if (step_s > longest_s) {
    return fmt::format(
        "frame times grow by {:.3g} from frame to frame: expected seconds, after {:g} of which "
        "nobody is known again; are they milliseconds?",
        step_s, longest_s);
  }
  if (step_s < kShortest_s) {
    return fmt::format(
        "frame times grow by {:.3g} from frame to frame: expected seconds of a camera, each later "
        "than the one before",
        step_s);
  }
  return "";
}

}  // namespace

void FrameTimeCheck::Add(double time_s) {
  constexpr size_t kEnough = 5;  // by hand: of fewer steps the median may be a pause
  const std::optional<double> before_s = std::exchange(last_s_, time_s);
  if (judged_ || !before_s) return;
  steps_s_.push_back(time_s - *before_s);
  if (steps_s_.size() < kEnough) return;
  judged_ = true;
  std::string wrong = Describe(Median(std::exchange(steps_s_, {})));
  if (!wrong.empty()) warning_ = std::move(wrong);
}

void FrameTimeCheck::AddPeople(std::map<int, Eigen::Vector3d> positions_m) {
  if (speeds_judged_ || !last_s_) return;
  const double step_s = people_s_ ? *last_s_ - *people_s_ : 0.0;
  if (step_s > 0.0) {
    for (const auto& [id, position_m] : positions_m) {
      const auto before = people_m_.find(id);
      if (before == people_m_.end()) continue;
      speeds_mps_.push_back((position_m - before->second).norm() / step_s);
    }
  }
  people_m_ = std::move(positions_m);
  people_s_ = last_s_;
  JudgeSpeeds();
}

// Of five real recordings of 5 frames a second, read at 30, 66 to 100 % of the first speeds are
// above kRunning_mps; of those read at their rate, of 10 read at 30, or by a sensor in somebody's
// hand, less than a tenth.
void FrameTimeCheck::JudgeSpeeds() {
  constexpr size_t kEnough = 40;        // by hand
  constexpr size_t kMost = 1000;        // by hand: a rate does not become wrong later
  constexpr double kRunning_mps = 4.0;  // m/s, by hand: nobody runs faster before a depth camera
  constexpr double kMostRunning = 0.2;  // share of the speeds, no unit; by hand
  if (speeds_mps_.size() < kEnough) return;
  const auto running = std::count_if(speeds_mps_.begin(), speeds_mps_.end(),
                                     [](double speed_mps) { return speed_mps > kRunning_mps; });
  const double share = static_cast<double>(running) / static_cast<double>(speeds_mps_.size());
  speeds_judged_ = share > kMostRunning || speeds_mps_.size() >= kMost;
  if (!speeds_judged_) return;
  std::vector<double> speeds_mps = std::exchange(speeds_mps_, {});
  if (share <= kMostRunning) return;
  warning_ = fmt::format(
      "by the frame times people move at {:.1f} m/s, the median, and {:.0f} % of the time faster "
      "than {:g} m/s: expected the rate at which the images were taken; state it (--fps, fps)",
      Median(std::move(speeds_mps)), 100.0 * share, kRunning_mps);
}

std::optional<std::string> FrameTimeCheck::TakeWarning() {
  return std::exchange(warning_, std::nullopt);
}

}  // namespace ossa::tracker
