#include "tools/experiments/compare/absent_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "depth/base/statistics.h"

namespace ossa::tools {
namespace {

using recon::SkeletonFrame;

constexpr double kShortestStep_s = 1e-3;  // no sensor is faster; bounds the work for absurd times
constexpr double kNever_s = std::numeric_limits<double>::infinity();

// Quantile of the time steps; a thirtieth of a second if there are none.
double StepAt(const std::vector<double>& time_s, double share) {
  std::vector<double> steps;
  for (size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 1.0 / 30.0;
  const auto rank = static_cast<size_t>(share * static_cast<double>(steps.size() - 1));
  return std::max(SelectRank(steps, rank), kShortestStep_s);
}

// Frames are expected at start_s + k step_s, k = 1, 2, ..., while less than end_s.
struct Gap {
  double start_s, end_s, step_s;
};

// Index of the truth near an expected time: at a frame if one is near, else between two.
class KnownTruth {
 public:
  explicit KnownTruth(const FramesDue& due) : due_(due) {}

  std::optional<double> Near(double time_s, double within_s) const {
    const double next_s = NextFrom(time_s);
    const double last_s = LastBefore(time_s);
    const double nearest_s = next_s - time_s < time_s - last_s ? next_s : last_s;
    if (std::abs(nearest_s - time_s) <= within_s) return nearest_s;
    if (next_s - last_s <= due_.longest_gap_s) return time_s;
    return std::nullopt;
  }
  double NextFrom(double time_s) const {
    const auto next = std::lower_bound(due_.truth_s.begin(), due_.truth_s.end(), time_s);
    return next == due_.truth_s.end() ? kNever_s : *next;
  }

 private:
  double LastBefore(double time_s) const {
    const auto next = std::lower_bound(due_.truth_s.begin(), due_.truth_s.end(), time_s);
    return next == due_.truth_s.begin() ? -kNever_s : *(next - 1);
  }
  const FramesDue& due_;
};

void AddDue(const KnownTruth& truth, const Gap& gap, std::vector<double>* absent_s) {
  for (double k = 1; gap.start_s + k * gap.step_s < gap.end_s;) {
    const double time_s = gap.start_s + k * gap.step_s;
    if (const auto known_s = truth.Near(time_s, 0.5 * gap.step_s)) {
      if (absent_s->empty() || *known_s > absent_s->back()) absent_s->push_back(*known_s);
      ++k;
    } else {
      // Skips a gap of the truth in one step, whatever its length.
      const double next_s = truth.NextFrom(time_s);
      if (next_s == kNever_s) return;
      k = std::max(k + 1, std::floor((next_s - gap.start_s) / gap.step_s));
    }
  }
}

// In order: before the result's first frame, between its frames, after its last.
std::vector<Gap> FindGaps(const std::vector<double>& time_s, const FramesDue& due) {
  const double step_s = StepAt(time_s, 0.25);
  // If the truth has a lower frame rate than the result, its time step is not a gap.
  const double shortest_gap_s = 1.5 * std::max(step_s, StepAt(due.truth_s, 0.5));
  std::vector<Gap> gaps;
  const double early_s = time_s.front() - due.truth_s.front();
  if (due.same_clock && early_s > 0.75 * step_s) {
    const double steps = std::round(early_s / step_s) + 1;
    gaps.push_back({time_s.front() - steps * step_s, time_s.front() - 0.5 * step_s, step_s});
  }
  for (size_t i = 1; i < time_s.size(); ++i) {
    const double length_s = time_s[i] - time_s[i - 1];
    if (length_s < shortest_gap_s) continue;
    const double even_s = length_s / std::max(1.0, std::round(length_s / step_s));
    gaps.push_back({time_s[i - 1], time_s[i] - 0.5 * even_s, even_s});
  }
  if (due.same_clock && due.truth_s.back() - time_s.back() > 0.75 * step_s) {
    gaps.push_back({time_s.back(), due.truth_s.back() + 0.5 * step_s, step_s});
  }
  return gaps;
}

}  // namespace

void AddAbsentFrames(const FramesDue& due, std::vector<SkeletonFrame>* frames) {
  if (frames->empty() || due.truth_s.empty()) return;
  std::vector<double> time_s;
  for (const SkeletonFrame& frame : *frames) {
    if (time_s.empty() || frame.time_s > time_s.back()) time_s.push_back(frame.time_s);
  }
  if (time_s.back() < due.truth_s.front() || time_s.front() > due.truth_s.back()) return;
  std::vector<double> absent_s;
  for (const Gap& gap : FindGaps(time_s, due)) AddDue(KnownTruth(due), gap, &absent_s);
  for (const double absent : absent_s) {
    SkeletonFrame frame;
    frame.time_s = absent;
    frames->push_back(frame);
  }
  std::stable_sort(
      frames->begin(), frames->end(),
      [](const SkeletonFrame& a, const SkeletonFrame& b) { return a.time_s < b.time_s; });
}

}  // namespace ossa::tools
