// The character as a filter: what it takes away of the jitter, and what it costs in delay.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "physics/character_filter.h"
#include "tools/experiments/recordings.h"
#include "tools/experiments/shum_ho_2012_internal.h"

namespace ossa::tools {
namespace {

using Eigen::Vector3d;
using recon::kJointCount;
using recon::Posture;

/// A target sequence with its truth; joints without truth are left out of the errors.
struct Case {
  std::vector<Posture> observed, truth;
  std::vector<std::array<bool, kJointCount>> known;
  std::optional<Eigen::Vector4d> floor;
};

struct Errors {
  double position = 0.0, relative = 0.0, acceleration = 0.0;  // sums, metres
  int64_t positions = 0, relatives = 0, accelerations = 0;
};

Vector3d SecondDifference(const std::vector<Posture>& postures, size_t f, size_t j) {
  return postures[f].position_m[j] - 2.0 * postures[f - 1].position_m[j] +
         postures[f - 2].position_m[j];
}

/// Eq. 18 of Shum 2013 and the acceleration error, over joints with truth.
void Add(const Case& c, const std::vector<Posture>& result, Errors& e) {
  for (size_t f = 0; f < result.size(); ++f) {
    for (size_t j = 0; j < kJointCount; ++j) {
      if (!c.known[f][j]) continue;
      const Vector3d off = result[f].position_m[j] - c.truth[f].position_m[j];
      e.position += off.norm();
      ++e.positions;
      const int parent = recon::kJointParent[j];
      if (parent >= 0 && c.known[f][static_cast<size_t>(parent)]) {
        const auto p = static_cast<size_t>(parent);
        e.relative += (off - result[f].position_m[p] + c.truth[f].position_m[p]).norm();
        ++e.relatives;
      }
      if (f < 2 || !c.known[f - 1][j] || !c.known[f - 2][j]) continue;
      e.acceleration += (SecondDifference(result, f, j) - SecondDifference(c.truth, f, j)).norm();
      ++e.accelerations;
    }
  }
}

/// Delay in frames: the shift of the unfiltered motion that fits the filtered best.
double Delay(const std::vector<Posture>& observed, const std::vector<Posture>& filtered) {
  double best = 1e300, delay = 0.0;
  for (double shift = -1.0; shift <= 4.0; shift += 0.05) {
    const auto whole = static_cast<std::ptrdiff_t>(std::floor(shift));
    const double part = shift - static_cast<double>(whole);
    double sum = 0.0;
    for (std::ptrdiff_t f = 6; f + 3 < std::ssize(filtered); ++f) {
      for (size_t j = 0; j < kJointCount; ++j) {
        const Vector3d at = (1.0 - part) * observed[static_cast<size_t>(f - whole)].position_m[j] +
                            part * observed[static_cast<size_t>(f - whole - 1)].position_m[j];
        sum += (filtered[static_cast<size_t>(f)].position_m[j] - at).squaredNorm();
      }
    }
    if (sum < best) {
      best = sum;
      delay = shift;
    }
  }
  return delay;
}

recon::BoneLengths MedianLengths(const std::vector<Posture>& postures) {
  recon::BoneLengths lengths{};
  for (size_t i = 1; i < kJointCount; ++i) {
    std::vector<double> all;
    for (const Posture& p : postures) all.push_back(recon::BoneLengthsOf(p)[i]);
    const auto middle = all.begin() + std::ssize(all) / 2;
    std::nth_element(all.begin(), middle, all.end());
    lengths[i] = std::clamp(*middle, 0.02, 1.5);
  }
  return lengths;
}

/// Sensor noise: half white, half wandering (correlation 0.8 from frame to frame), and in one frame
/// of a hundred a joint 10 cm off.
Case Noisy(const std::vector<Posture>& truth, double sigma_m, uint64_t seed) {
  Case c;
  c.truth = truth;
  c.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto draw = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  std::array<Vector3d, kJointCount> wander;
  wander.fill(Vector3d::Zero());
  for (const Posture& t : truth) {
    Posture p = t;
    for (size_t j = 0; j < kJointCount; ++j) {
      wander[j] = 0.8 * wander[j] + 0.6 * draw();
      p.position_m[j] += sigma_m * std::sqrt(0.5) * (wander[j] + draw());
      if (sigma_m > 0.0 && uniform(random) < 0.01) p.position_m[j] += 0.1 * draw();
    }
    c.observed.push_back(p);
    c.known.emplace_back().fill(true);
  }
  return c;
}

std::vector<Case> AuthoredCases(const Actors& actors, double sigma_m, uint64_t seed) {
  std::vector<Case> cases;
  for (const char* action : {"walk", "punch", "kick", "tai_chi", "wave", "jumping_jacks", "squat",
                             "throw", "golf", "clap", "stand", "march"}) {
    cases.push_back(Noisy(actors.Play(action), sigma_m, seed + cases.size()));
  }
  return cases;
}

/// Every `stride`-th correct performance; hands that Kinect rows lack continue the forearm.
std::vector<Case> RealCases(const std::filesystem::path& shared, size_t stride) {
  std::vector<Case> cases;
  const auto pairs = LoadUiPrmd(shared, false);
  for (size_t k = 0; k < pairs.size(); k += stride) {
    Case c;
    const auto& observed = pairs[k].observed.frames;
    const auto& truth = pairs[k].truth.frames;
    for (size_t f = 0; f < std::min(observed.size(), truth.size()); ++f) {
      if (observed[f].bodies.empty() || truth[f].bodies.empty()) continue;
      Posture p, t;
      auto& known = c.known.emplace_back();
      for (size_t j = 0; j < kJointCount; ++j) {
        const auto& seen = observed[f].bodies[0].joints[j];
        const auto& real = truth[f].bodies[0].joints[j];
        const auto parent = static_cast<size_t>(std::max(0, recon::kJointParent[j]));
        const auto grand = static_cast<size_t>(std::max(0, recon::kJointParent[parent]));
        p.position_m[j] = seen ? seen->position_m
                               : Vector3d(1.3 * p.position_m[parent] - 0.3 * p.position_m[grand]);
        known[j] = seen && real;
        if (real) t.position_m[j] = real->position_m;
      }
      c.observed.push_back(p);
      c.truth.push_back(t);
    }
    if (c.observed.size() > 30) cases.push_back(std::move(c));
  }
  return cases;
}

struct Measured {
  Errors raw, filtered;
  double delay = 0.0, depth_m = 0.0, gap_m = 0.0, slide_m = 0.0, length_error = 0.0, ms = 0.0;
  int64_t frames = 0;
};

/// How far pinned feet wander from where they were when they were pinned.
class SlideMeter {
 public:
  void See(const physics::FilteredPosture& out) {
    Foot(0, out.left_foot_pinned, out.posture[recon::Joint::kFootLeft]);
    Foot(1, out.right_foot_pinned, out.posture[recon::Joint::kFootRight]);
  }
  double largest_m() const { return largest_m_; }

 private:
  void Foot(size_t side, bool pinned, const Vector3d& at) {
    if (pinned && !pinned_[side]) start_[side] = at;
    pinned_[side] = pinned;
    if (pinned) largest_m_ = std::max(largest_m_, (at - start_[side]).norm());
  }
  std::array<bool, 2> pinned_{};
  std::array<Vector3d, 2> start_{Vector3d::Zero(), Vector3d::Zero()};
  double largest_m_ = 0.0;
};

void Run(const Case& c, const physics::CharacterFilterOptions& options, Measured& m) {
  const recon::BoneLengths lengths = MedianLengths(c.observed);
  physics::CharacterFilter filter(lengths, options);
  SlideMeter slide;
  std::vector<Posture> result;
  const double start_ms = ProcessorMs();
  for (const Posture& target : c.observed) {
    const auto out = filter.Step(target, {}, c.floor, 1.0 / 30.0);
    result.push_back(out.posture);
    m.depth_m = std::max(m.depth_m, out.floor_depth_m);
    m.gap_m = std::max(m.gap_m, out.max_solver_gap_m);
    slide.See(out);
    const auto now = recon::BoneLengthsOf(out.posture);
    for (size_t i = 1; i < kJointCount; ++i) {
      m.length_error = std::max(m.length_error, std::abs(now[i] / lengths[i] - 1.0));
    }
  }
  m.ms += ProcessorMs() - start_ms;
  m.slide_m = std::max(m.slide_m, slide.largest_m());
  m.frames += std::ssize(result);
  m.delay += Delay(c.observed, result) * static_cast<double>(result.size());
  Add(c, c.observed, m.raw);
  Add(c, result, m.filtered);
}

std::string FromTo(double raw_sum, int64_t raw_n, double sum, int64_t n) {
  if (raw_n == 0 || n == 0) return "-";
  return fmt::format("{:.2f} -> {:.2f}", 100 * raw_sum / static_cast<double>(raw_n),
                     100 * sum / static_cast<double>(n));
}

void AddRow(Table& table, const std::string& data, const std::string& control,
            const std::vector<Case>& cases, const physics::CharacterFilterOptions& options) {
  Measured m;
  for (const Case& c : cases) Run(c, options, m);
  const auto frames = static_cast<double>(std::max<int64_t>(m.frames, 1));
  const Errors &r = m.raw, &f = m.filtered;
  table.rows.push_back(
      {data, control, std::to_string(m.frames),
       FromTo(r.position, r.positions, f.position, f.positions),
       FromTo(r.relative, r.relatives, f.relative, f.relatives),
       FromTo(r.acceleration, r.accelerations, f.acceleration, f.accelerations),
       fmt::format("{:.2f}", m.delay / frames), fmt::format("{:.1f}", 1e3 * m.depth_m),
       fmt::format("{:.1f}", 1e3 * m.slide_m), fmt::format("{:.2f}", 1e3 * m.gap_m),
       fmt::format("{:.4f}", 100 * m.length_error), fmt::format("{:.2f}", m.ms / frames)});
}

}  // namespace

Table FilterStudy(ExperimentContext& context, const Actors& actors) {
  Table table;
  table.title = "The character as a filter: unfiltered -> filtered";
  table.columns = {"postures",      "control",        "frames",
                   "mean error cm", "eq. 18 cm",      "acceleration error cm/frame^2",
                   "delay frames",  "floor depth mm", "pinned slide mm",
                   "joint gap mm",  "length error %", "ms/frame"};
  const double stride = context.parameters.Number("filter_stride", 16);
  physics::CharacterFilterOptions paper, plain, motor;
  plain.lead = 0.0;
  motor.control = physics::Control::kMotor;
  const auto add = [&](const std::string& data, const std::vector<Case>& cases) {
    AddRow(table, data, "paper", cases, paper);
    AddRow(table, data, "paper, lead 0", cases, plain);
    AddRow(table, data, "motor", cases, motor);
  };
  for (const double sigma_cm : {0.0, 1.0, 3.0}) {
    add(fmt::format("authored, noise {:.0f} cm", sigma_cm),
        AuthoredCases(actors, 0.01 * sigma_cm, context.seed));
  }
  if (context.shared.empty()) {
    table.note = "UI-PRMD left out: no --shared folder was given.";
  } else {
    add("UI-PRMD, Kinect against Vicon",
        RealCases(context.shared, static_cast<size_t>(std::max(1.0, stride))));
    table.note = fmt::format("UI-PRMD: every {:.0f}th correct performance, no floor.", stride);
  }
  return table;
}

}  // namespace ossa::tools
