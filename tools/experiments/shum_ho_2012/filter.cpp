// The character as a filter: reduction of jitter, and delay.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "depth/base/statistics.h"
#include "physics/character_filter.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/shum_ho_2012/filter_internal.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand unless stated otherwise.

using Eigen::Vector3d;
using recon::Joint;
using recon::kJointCount;
using recon::Posture;

/// Sum over the joints of squared distances between `filtered` and `observed` shifted by `shift`
/// frames.
double MisfitAt(double shift, const std::vector<SparsePosture>& observed,
                const std::vector<SparsePosture>& filtered) {
  const auto whole = static_cast<std::ptrdiff_t>(std::floor(shift));
  const double part = shift - static_cast<double>(whole);
  double sum = 0.0;
  for (std::ptrdiff_t f = 6; f + 3 < std::ssize(filtered); ++f) {
    const SparsePosture& now = observed[static_cast<size_t>(f - whole)];
    const SparsePosture& before = observed[static_cast<size_t>(f - whole - 1)];
    for (size_t j = 0; j < kJointCount; ++j) {
      if (!now.present[j] || !before.present[j]) continue;
      const Vector3d at = (1.0 - part) * now.position_m[j] + part * before.position_m[j];
      sum += (filtered[static_cast<size_t>(f)].position_m[j] - at).squaredNorm();
    }
  }
  return sum;
}

/// Delay in frames: the shift of the unfiltered motion that fits the filtered motion best.
double Delay(const std::vector<SparsePosture>& observed,
             const std::vector<SparsePosture>& filtered) {
  double best = std::numeric_limits<double>::infinity(), delay = 0.0;
  for (double shift = -1.0; shift <= 4.0; shift += 0.05) {
    const double misfit = MisfitAt(shift, observed, filtered);
    if (misfit >= best) continue;
    best = misfit;
    delay = shift;
  }
  return delay;
}

/// Sensor postures as input of the filter: unseen joints are NaN.
class Targets {
 public:
  explicit Targets(const std::vector<SparsePosture>& seen);
  const Posture& At(size_t f) const { return postures_[f]; }
  /// Median length of every bone; a bone that was never seen is as long as a hand.
  recon::BoneLengths MedianLengths() const;

 private:
  std::vector<Posture> postures_;
};

/// Adds joints that the sensor lacks: the hip centre between the hips, wrists and ankles on the way
/// from elbow to hand and from knee to foot.
void FillUnnamed(const recon::JointArray<bool>& named, Posture& target) {
  constexpr double kMostOfTheWay = 0.75;  // share of a step
  if (!named[0]) {
    target[Joint::kHipCenter] = 0.5 * (target[Joint::kHipLeft] + target[Joint::kHipRight]);
  }
  for (const size_t end : {7U, 11U, 15U, 19U}) {
    if (named[end - 1]) continue;
    target.position_m[end - 1] =
        (1.0 - kMostOfTheWay) * target.position_m[end - 2] + kMostOfTheWay * target.position_m[end];
  }
}

Targets::Targets(const std::vector<SparsePosture>& seen) {
  recon::JointArray<bool> named{};
  for (const SparsePosture& s : seen) {
    for (size_t j = 0; j < kJointCount; ++j) named[j] = named[j] || s.present[j];
  }
  for (const SparsePosture& s : seen) {
    Posture& target = postures_.emplace_back();
    target.position_m = s.position_m;
    for (size_t j = 0; j < kJointCount; ++j) {
      if (!s.present[j]) {
        target.position_m[j].setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
    FillUnnamed(named, target);
  }
}

recon::BoneLengths Targets::MedianLengths() const {
  constexpr double kUnseen_m = 0.09;
  recon::BoneLengths lengths{};
  for (size_t i = 1; i < kJointCount; ++i) {
    std::vector<double> all;
    for (const Posture& p : postures_) {
      const double length = recon::MeasureBoneLengths(p)[i];
      if (std::isfinite(length)) all.push_back(length);
    }
    lengths[i] = all.empty() ? kUnseen_m : std::clamp(ossa::Median(std::move(all)), 0.02, 1.5);
  }
  return lengths;
}

/// Drift of pinned feet, and how well pins distinguish standing feet from moving ones.
class FootMeter {
 public:
  void AddFrame(const physics::FilteredPosture& out, const FilterCase& c, size_t f) {
    Foot(0, out.left_foot_pinned, Index(Joint::kFootLeft), out, c, f);
    Foot(1, out.right_foot_pinned, Index(Joint::kFootRight), out, c, f);
  }
  void Reset() { pinned_ = {}; }
  double largest_m() const { return largest_m_; }
  std::string StandingPinned() const { return Share(standing_pinned_, standing_); }
  std::string MovingPinned() const { return Share(moving_pinned_, moving_); }

 private:
  static std::string Share(int part, int whole) {
    return whole == 0 ? "-" : fmt::format("{:.0f}", 100.0 * part / whole);
  }

  void Foot(size_t side, bool pinned, size_t joint, const physics::FilteredPosture& out,
            const FilterCase& c, size_t f) {
    const Vector3d& at = out.posture.position_m[joint];
    if (pinned && !pinned_[side]) start_[side] = at;
    pinned_[side] = pinned;
    if (pinned) largest_m_ = std::max(largest_m_, (at - start_[side]).norm());
    if (f == 0 || !c.floor) return;
    const SparsePosture &now = c.tracks.truth[f], &before = c.tracks.truth[f - 1];
    if (!now.present[joint] || !before.present[joint]) return;
    // Speeds of true feet that stand and that move; speeds in between count as neither.
    constexpr double kStands_m_s = 0.05, kMoves_m_s = 0.5, kLow_m = 0.12;
    const double speed = (now.position_m[joint] - before.position_m[joint]).norm() /
                         (c.tracks.time_s[f] - c.tracks.time_s[f - 1]);
    const double height = c.floor->head<3>().dot(now.position_m[joint]) + (*c.floor)[3];
    const bool stands = speed < kStands_m_s && height<kLow_m, moves = speed> kMoves_m_s;
    standing_ += stands ? 1 : 0;
    standing_pinned_ += stands && pinned ? 1 : 0;
    moving_ += moves ? 1 : 0;
    moving_pinned_ += moves && pinned ? 1 : 0;
  }

  std::array<bool, 2> pinned_{};
  std::array<Vector3d, 2> start_{Vector3d::Zero(), Vector3d::Zero()};
  double largest_m_ = 0.0;
  int standing_ = 0, standing_pinned_ = 0, moving_ = 0, moving_pinned_ = 0;
};

struct Measured {
  std::vector<ClipMetrics> raw, filtered;
  FootMeter feet;
  double delay = 0.0, depth_m = 0.0, gap_m = 0.0, length_error = 0.0, ms = 0.0;
  int64_t frames = 0;
};

/// Only joints that the sensor saw count, so that filled-in joints are not evaluated.
SparsePosture KeepSeenJoints(const Posture& filtered, const SparsePosture& seen) {
  SparsePosture result = seen;
  result.position_m = filtered.position_m;
  return result;
}

void Run(const FilterCase& c, const physics::CharacterFilterOptions& options, Measured& m) {
  const auto& observed = c.tracks.result;
  const Targets targets(observed);
  const recon::BoneLengths lengths = targets.MedianLengths();
  physics::CharacterFilter filter(lengths, options);
  PairedTracks result = c.tracks;
  m.feet.Reset();
  for (size_t f = 0; f < observed.size(); ++f) {
    const double dt_s = f == 0 ? 1.0 / 30.0 : c.tracks.time_s[f] - c.tracks.time_s[f - 1];
    const double start_ms = ProcessorTime_ms();
    const auto out = filter.Step(targets.At(f), {}, c.floor, dt_s);
    m.ms += ProcessorTime_ms() - start_ms;
    result.result[f] = KeepSeenJoints(out.posture, observed[f]);
    m.depth_m = std::max(m.depth_m, out.floor_depth_m);
    m.gap_m = std::max(m.gap_m, out.max_anchor_gap_m);
    m.feet.AddFrame(out, c, f);
    const auto now = recon::MeasureBoneLengths(out.posture);
    for (size_t i = 1; i < kJointCount; ++i) {
      m.length_error = std::max(m.length_error, std::abs(now[i] / lengths[i] - 1.0));
    }
  }
  m.frames += std::ssize(observed);
  m.delay += Delay(observed, result.result) * static_cast<double>(observed.size());
  m.raw.push_back(Measure(c.tracks));
  m.filtered.push_back(Measure(result));
}

void AddRow(Table& table, const FilterData& data, const std::string& control,
            const physics::CharacterFilterOptions& options) {
  Measured m;
  for (const FilterCase& c : data.cases) Run(c, options, m);
  const auto frames = static_cast<double>(std::max<int64_t>(m.frames, 1));
  const ClipMetrics raw = MeanOverClips("raw", m.raw), filtered = MeanOverClips("", m.filtered);
  const auto from_to = [&](std::optional<double> ClipMetrics::*member) {
    return Cell(raw.*member) + " -> " + Cell(filtered.*member);
  };
  table.rows.push_back(
      {data.name, control, std::to_string(m.frames), from_to(&ClipMetrics::mean_joint_error_cm),
       from_to(&ClipMetrics::parent_relative_error_cm),
       from_to(&ClipMetrics::acceleration_error_cm_per_frame2),
       fmt::format("{:.2f}", m.delay / frames), fmt::format("{:.1f}", 1e3 * m.depth_m),
       fmt::format("{:.1f}", 1e3 * m.feet.largest_m()), m.feet.StandingPinned(),
       m.feet.MovingPinned(), fmt::format("{:.2f}", 1e3 * m.gap_m),
       fmt::format("{:.4f}", 100 * m.length_error), fmt::format("{:.2f}", m.ms / frames)});
}

}  // namespace

Table FilterStudy(ExperimentContext& context, const ActionClips& clips) {
  Table table;
  table.title = "The character as a filter: unfiltered -> filtered, mean over clips";
  table.columns = {"postures",
                   "control",
                   "frames",
                   "mean error cm",
                   "eq. 18 cm",
                   "acceleration error cm/frame^2",
                   "delay frames",
                   "floor depth mm",
                   "pinned slide mm",
                   "standing feet pinned %",
                   "moving feet pinned %",
                   "joint gap mm",
                   "length error %",
                   "ms/frame"};
  physics::CharacterFilterOptions paper, plain, motor;
  plain.lead = 0.0;
  motor.control = physics::Control::kMotor;
  for (const FilterData& data : MakeFilterData(context, clips, table.note)) {
    context.ThrowIfInterrupted();
    AddRow(table, data, "pd", paper);
    AddRow(table, data, "pd, lead 0", plain);
    AddRow(table, data, "motor", motor);
  }
  return table;
}

}  // namespace ossa::tools
