#include "tools/experiments/compare/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/experiments/experiment.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand.

constexpr double kStep_s = 0.01;       // of the grid of times
constexpr double kHalf_s = 0.05;       // speeds over a tenth of a second: above the sensor's jitter
constexpr double kLongest_s = 2000.0;  // that is looked at; for memory

// Speed of every joint at evenly spaced times, and where it is known. speed[joint][time]. Joints
// are kept apart: their sum over a whole body is nearly constant in many motions and would say
// little about time.
struct Speeds {
  recon::JointArray<std::vector<double>> speed;
  recon::JointArray<std::vector<bool>> known;
};

Speeds ComputeSpeeds(const JointTrack& track, double start_s, double step_s, size_t count) {
  Speeds speeds;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    speeds.speed[j].assign(count, 0.0);
    speeds.known[j].assign(count, false);
  }
  for (size_t i = 0; i < count; ++i) {
    const double time_s = start_s + static_cast<double>(i) * step_s;
    const auto before = PostureAt(track, time_s - kHalf_s);
    const auto after = PostureAt(track, time_s + kHalf_s);
    for (size_t j = 0; before && after && j < recon::kJointCount; ++j) {
      if (!before->present[j] || !after->present[j]) continue;
      speeds.known[j][i] = true;
      speeds.speed[j][i] = (after->position_m[j] - before->position_m[j]).norm();
    }
  }
  return speeds;
}

struct Correlation {
  double value = 0.0;         // [-1, 1]
  double significance = 0.0;  // standard errors
};

// Fisher 1915: atanh(r) has a standard error of 1 / sqrt(n - 3). The largest correlation alone
// shifts half a squat onto its other half, whose speeds are the same: a short overlap fits better
// than the whole does.
double Significance(double correlation, long shared) {
  constexpr double kIndependent_s = 2 * kHalf_s;  // apart, speeds have no place in common
  constexpr double kPerfect = 1 - 1e-9;           // a factor, by hand: atanh(1) is infinite
  const double samples = static_cast<double>(shared) * kStep_s / kIndependent_s;
  // Of overlaps too short for the formula the correlation alone decides.
  const double standard_errors = std::sqrt(std::max(1.0, samples - 3));
  return std::atanh(std::clamp(correlation, -kPerfect, kPerfect)) * standard_errors;
}

// Pearson's correlation of a(t) with b(t - shift), covariances and variances summed over the
// joints. Only times that both know count, else the ends of a clip would pull the peak to zero.
// Fewer shared times than `fewest` give no correlation: short overlaps fit anything.
Correlation Correlate(const Speeds& a, const Speeds& b, long shift, long fewest) {
  const auto count = static_cast<long>(a.speed[0].size());
  double covariance = 0;
  double variance_a = 0;
  double variance_b = 0;
  long shared = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (long i = std::max(0L, shift); i < count + std::min(0L, shift); ++i) {
      const auto at_a = static_cast<size_t>(i);
      const auto at_b = static_cast<size_t>(i - shift);
      if (!a.known[j][at_a] || !b.known[j][at_b]) continue;
      const double u = a.speed[j][at_a];
      const double v = b.speed[j][at_b];
      ++n;
      x += u;
      y += v;
      xx += u * u;
      yy += v * v;
      xy += u * v;
    }
    if (n < 2) continue;
    covariance += xy - x * y / n;
    variance_a += xx - x * x / n;
    variance_b += yy - y * y / n;
    shared = std::max(shared, static_cast<long>(n));
  }
  const double variance = std::sqrt(variance_a * variance_b);
  if (shared < fewest || variance <= 0) return {};
  const double correlation = covariance / variance;
  return {correlation, Significance(correlation, shared)};
}

// Half of the shorter recording must overlap.
long FewestShared(const Speeds& a, const Speeds& b) {
  const auto longest = [](const Speeds& speeds) {
    long most = 0;
    for (const auto& known : speeds.known) {
      most = std::max(most, static_cast<long>(std::count(known.begin(), known.end(), true)));
    }
    return most;
  };
  return std::max(2L, std::min(longest(a), longest(b)) / 2);
}

ClockMatch MatchNear(const JointTrack& truth, JointTrack result, double guess_s,
                     double max_offset_s, const std::function<bool()>& stop) {
  for (double& time_s : result.time_s) time_s += guess_s;
  ClockMatch match = MatchClocks(truth, result, max_offset_s, stop);
  match.offset_s += guess_s;
  return match;
}

bool MayOverlap(const JointTrack& truth, const JointTrack& result, double max_offset_s) {
  return result.time_s.front() - max_offset_s <= truth.time_s.back() &&
         result.time_s.back() + max_offset_s >= truth.time_s.front();
}

}  // namespace

ClockMatch MatchClocks(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                       const std::function<bool()>& stop) {
  if (truth.time_s.size() < 3 || result.time_s.size() < 3) return {};
  const double start_s = std::min(truth.time_s.front(), result.time_s.front());
  const double end_s = std::max(truth.time_s.back(), result.time_s.back());
  const auto count = static_cast<size_t>(std::min(end_s - start_s, kLongest_s) / kStep_s + 1);
  const Speeds a = ComputeSpeeds(truth, start_s, kStep_s, count);
  const Speeds b = ComputeSpeeds(result, start_s, kStep_s, count);
  const long reach = std::lround(max_offset_s / kStep_s);
  std::vector<Correlation> score;
  const long fewest = FewestShared(a, b);
  for (long shift = -reach; shift <= reach; ++shift) {
    if (stop && stop()) throw Interruption{};
    score.push_back(Correlate(a, b, shift, fewest));
  }
  // Of equal peaks the smallest offset: someone who stands still gives no reason to move the clock.
  size_t best = static_cast<size_t>(reach);
  for (size_t i = 0; i < score.size(); ++i) {
    if (score[i].significance > score[best].significance + 1e-9) best = i;
  }
  double shift = static_cast<double>(best) - static_cast<double>(reach);
  if (best > 0 && best + 1 < score.size()) {
    const double before = score[best - 1].value, after = score[best + 1].value;
    const double curvature = before - 2 * score[best].value + after;
    if (curvature < -1e-12) shift += std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
  }
  return {shift * kStep_s, score[best].significance};
}

double FindClockOffset_s(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                         const std::function<bool()>& stop) {
  const double starts_s = truth.time_s.front() - result.time_s.front();
  const ClockMatch together = MatchNear(truth, result, starts_s, max_offset_s, stop);
  // Else equal clocks were among those that were looked at.
  const bool is_far = std::abs(starts_s) > max_offset_s;
  if (!is_far || !MayOverlap(truth, result, max_offset_s)) return together.offset_s;
  const ClockMatch equal = MatchClocks(truth, result, max_offset_s, stop);
  return equal.significance > together.significance ? equal.offset_s : together.offset_s;
}

}  // namespace ossa::tools
