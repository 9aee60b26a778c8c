#include "tools/tracker/frame_time_check.h"

#include <fmt/format.h>

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
  if (judged_) return;
  if (last_s_) steps_s_.push_back(time_s - *last_s_);
  last_s_ = time_s;
  if (steps_s_.size() < kEnough) return;
  judged_ = true;
  std::string wrong = Describe(Median(std::exchange(steps_s_, {})));
  if (!wrong.empty()) warning_ = std::move(wrong);
}

std::optional<std::string> FrameTimeCheck::TakeWarning() {
  return std::exchange(warning_, std::nullopt);
}

}  // namespace ossa::tracker
