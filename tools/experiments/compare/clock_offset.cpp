#include "tools/experiments/compare/clock_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "tools/experiments/compare/assign_bodies.h"
#include "tools/experiments/compare/rigid_transform.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand.

constexpr double kStep_s = 0.01;       // of the grid of times
constexpr double kHalf_s = 0.05;       // speeds over a tenth of a second: above the sensor's jitter
constexpr double kLongest_s = 2000.0;  // of a recording that is used; for memory

// Speed of every joint at evenly spaced times, speed[joint][time], and where it is known. Joints
// are kept separate: their sum over the body is nearly constant in many motions.
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
// would shift half a squat onto its other half, which has the same speeds: short overlaps fit
// better than long ones.
double Significance(double correlation, long shared) {
  constexpr double kIndependent_s = 2 * kHalf_s;  // farther apart, speeds share no positions
  constexpr double kPerfect = 1 - 1e-9;           // a factor, by hand: atanh(1) is infinite
  const double samples = static_cast<double>(shared) * kStep_s / kIndependent_s;
  // For overlaps too short for the formula, the correlation decides.
  const double standard_errors = std::sqrt(std::max(1.0, samples - 3));
  return std::atanh(std::clamp(correlation, -kPerfect, kPerfect)) * standard_errors;
}

// Sums for Pearson's correlation.
struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void Add(double u, double v) {
    ++n;
    x += u;
    y += v;
    xx += u * u;
    yy += v * v;
    xy += u * v;
  }
  double Covariance() const { return xy - x * y / n; }
  double VarianceX() const { return xx - x * x / n; }
  double VarianceY() const { return yy - y * y / n; }
};

// For several signals with separate means: covariances and variances are summed.
class PooledCorrelation {
 public:
  void Add(const Sums& sums) {
    if (sums.n < 2) return;
    covariance_ += sums.Covariance();
    variance_x_ += sums.VarianceX();
    variance_y_ += sums.VarianceY();
    most_ = std::max(most_, static_cast<long>(sums.n));
  }
  long most() const { return most_; }  // samples of one signal
  /// Empty for constant signals.
  std::optional<double> Value() const {
    const double variance = std::sqrt(variance_x_ * variance_y_);
    return variance > 0 ? std::optional(covariance_ / variance) : std::nullopt;
  }

 private:
  double covariance_ = 0, variance_x_ = 0, variance_y_ = 0;
  long most_ = 0;
};

// Pearson's correlation of a(t) with b(t - shift), pooled over the joints. Only times known to both
// count, else the ends of a clip would shift the peak to zero. Empty for fewer than `fewest` shared
// times: short overlaps fit anything.
Correlation Correlate(const Speeds& a, const Speeds& b, long shift, long fewest) {
  const auto count = static_cast<long>(a.speed[0].size());
  PooledCorrelation pooled;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    Sums sums;
    for (long i = std::max(0L, shift); i < count + std::min(0L, shift); ++i) {
      const auto at_a = static_cast<size_t>(i);
      const auto at_b = static_cast<size_t>(i - shift);
      if (!a.known[j][at_a] || !b.known[j][at_b]) continue;
      sums.Add(a.speed[j][at_a], b.speed[j][at_b]);
    }
    pooled.Add(sums);
  }
  const auto correlation = pooled.Value();
  if (pooled.most() < fewest || !correlation) return {};
  return {*correlation, Significance(*correlation, pooled.most())};
}

// Postures of both at the same times, the result rigidly aligned with the truth.
struct Aligned {
  std::vector<SparsePosture> truths, results;
};

Aligned AlignAt(const JointTrack& truth, const JointTrack& result, double shift_s) {
  CommonJoints common;
  Aligned aligned;
  for (size_t f = 0; f < result.time_s.size(); ++f) {
    if (result.time_s[f] > result.time_s.front() + kLongest_s) break;
    const auto posture = PostureAt(truth, result.time_s[f] + shift_s);
    if (!posture) continue;
    common.Add(result.postures[f], *posture);
    aligned.truths.push_back(*posture);
    aligned.results.push_back(result.postures[f]);
  }
  const auto transform = common.Align();
  if (!transform) return {};
  for (SparsePosture& posture : aligned.results) posture = Moved(*transform, std::move(posture));
  return aligned;
}

// Significance of the correlation of the joints' positions after rigid alignment. Speeds alone are
// ambiguous for repeated and reversed movements.
double PositionSignificance(const JointTrack& truth, const JointTrack& result, double shift_s) {
  const auto [truths, results] = AlignAt(truth, result, shift_s);
  PooledCorrelation pooled;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    std::array<Sums, 3> axes;
    for (size_t f = 0; f < truths.size(); ++f) {
      if (!truths[f].present[j] || !results[f].present[j]) continue;
      for (size_t a = 0; a < axes.size(); ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        axes[a].Add(truths[f].position_m[j][axis], results[f].position_m[j][axis]);
      }
    }
    for (const Sums& sums : axes) pooled.Add(sums);
  }
  const double frame_s = (result.time_s.back() - result.time_s.front()) /
                         static_cast<double>(result.time_s.size() - 1);
  const auto shared = std::lround(static_cast<double>(pooled.most()) * frame_s / kStep_s);
  return Significance(pooled.Value().value_or(0), shared);
}

// The most significant peaks of the correlation of the speeds, best first; of equal peaks the
// smallest offset. Without a peak (a person at rest) the middle: offset zero.
std::vector<size_t> FindPeaks(const std::vector<Correlation>& score) {
  constexpr double kLeastShare =
      0.1;  // of the best peak's significance, a ratio; by hand: 0.5 misses some
  constexpr size_t kMostPeaks =
      8;  // by hand: two seconds either way for a movement repeated twice a second
  const size_t middle = score.size() / 2;
  const auto at = [&](size_t i) { return i < score.size() ? score[i].significance : -1e9; };
  const auto offset = [&](size_t i) { return i > middle ? i - middle : middle - i; };
  std::vector<size_t> peaks;
  for (size_t i = 0; i < score.size(); ++i) {
    if (at(i) > 0 && at(i) >= at(i - 1) && at(i) > at(i + 1)) peaks.push_back(i);
  }
  if (peaks.empty()) return {middle};
  std::sort(peaks.begin(), peaks.end(), [&](size_t a, size_t b) {
    return at(a) != at(b) ? at(a) > at(b) : offset(a) < offset(b);
  });
  const double least = kLeastShare * at(peaks.front());
  while (peaks.size() > 1 && (at(peaks.back()) < least || peaks.size() > kMostPeaks)) {
    peaks.pop_back();
  }
  return peaks;
}

// The vertex of the parabola through the peak and its two neighbours.
double RefinedPeak(const std::vector<Correlation>& score, size_t peak) {
  const auto place = static_cast<double>(peak);
  if (peak == 0 || peak + 1 >= score.size()) return place;
  const double before = score[peak - 1].value, after = score[peak + 1].value;
  const double curvature = before - 2 * score[peak].value + after;
  if (curvature >= -1e-12) return place;
  return place + std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

// Half of the shorter recording must overlap.
long MinimumOverlap(const Speeds& a, const Speeds& b) {
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
  const long fewest = MinimumOverlap(a, b);
  for (long shift = -reach; shift <= reach; ++shift) {
    if (stop && stop()) throw Interruption{};
    score.push_back(Correlate(a, b, shift, fewest));
  }
  const auto offset_s = [reach](double at) { return (at - static_cast<double>(reach)) * kStep_s; };
  const std::vector<size_t> peaks = FindPeaks(score);
  size_t best = peaks.front();
  double most = 0;
  for (const size_t peak : peaks) {
    if (peaks.size() == 1) break;
    if (stop && stop()) throw Interruption{};
    const double agreement =
        PositionSignificance(truth, result, offset_s(static_cast<double>(peak)));
    if (agreement <= most) continue;
    best = peak;
    most = agreement;
  }
  return {offset_s(RefinedPeak(score, best)), score[best].significance};
}

double FindClockOffset_s(const JointTrack& truth, const JointTrack& result, double max_offset_s,
                         const std::function<bool()>& stop) {
  const double starts_s = truth.time_s.front() - result.time_s.front();
  const ClockMatch together = MatchNear(truth, result, starts_s, max_offset_s, stop);
  // Otherwise the search has covered equal clocks.
  const bool is_far = std::abs(starts_s) > max_offset_s;
  if (!is_far || !MayOverlap(truth, result, max_offset_s)) return together.offset_s;
  const ClockMatch equal = MatchClocks(truth, result, max_offset_s, stop);
  return equal.significance > together.significance ? equal.offset_s : together.offset_s;
}

}  // namespace ossa::tools
