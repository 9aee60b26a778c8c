#include "recon/motion/authored_moves_internal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

/// Slope of a monotone cubic at a point between two intervals (Fritsch & Carlson 1980; weighted
/// harmonic mean of the neighbours' slopes, 0 at extrema).
double MonotoneSlope(double h0, double d0, double h1, double d1) {
  if (d0 * d1 <= 0.0) return 0.0;
  const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

/// Amplitude of slow sway of each number of a BodyKey, degrees; none for feet and pelvis position,
/// which follow from balance and contact.
constexpr BodyKeyNumbers kSway = [] {
  BodyKeyNumbers sway{};
  sway[4] = 0.5, sway[5] = 0.4, sway[6] = 0.8;     // pelvis pitch, roll, twist
  sway[7] = 1.0, sway[8] = 0.7, sway[9] = 1.5;     // trunk bend, side, turn
  sway[10] = 2.5, sway[11] = 5.0, sway[12] = 1.5;  // head
  sway[13] = 0.05;                                 // weight
  for (const size_t arm : {size_t{17}, size_t{22}}) {
    sway[arm] = 1.5, sway[arm + 1] = 1.0, sway[arm + 2] = 0.004;
    sway[arm + 3] = 3.0, sway[arm + 4] = 4.0;
  }
  return sway;
}();
constexpr std::array<double, 3> kSwayHertz = {0.13, 0.29, 0.61};

}  // namespace

Moves::Moves(uint64_t seed) : random_(seed) {
  tempo_ = Between(0.85, 1.25);
  amplitude_ = Between(0.8, 1.15);
  sway_ = Between(0.5, 1.5);
  mirrored_ = Coin();
  for (auto& phases : sway_phase_) {
    for (double& phase : phases) phase = Between(0.0, 2.0 * std::numbers::pi);
  }
  const double width_m = Between(0.085, 0.16), toes = Between(-2.0, 10.0);
  for (size_t s = 0; s < 2; ++s) {
    ease_.leg[s].foot_m = Vector3d((s == 0 ? 1.0 : -1.0) * width_m, 0.0, Between(-0.03, 0.03));
    ease_.leg[s].yaw = toes + Between(-3.0, 3.0);
    ease_.arm[s].flex = Between(-2.0, 12.0);
    ease_.arm[s].abduct = Between(7.0, 14.0);
    ease_.arm[s].reach = Between(0.95, 0.985);
    ease_.arm[s].swivel = Between(-10.0, 15.0);
    ease_.arm[s].pronate = Between(-10.0, 25.0);
  }
  ease_.pelvis_m.y() = Between(0.855, 0.89);
  ease_.pitch = Between(-3.0, 5.0);
  ease_.bend = Between(-3.0, 8.0);
  ease_.nod = Between(-4.0, 8.0);
  ease_.weight = Between(0.4, 0.6);
  now = ease_;
  times_s_.push_back(0.0);
  keys_.push_back(ToNumbers(now));
}

void Moves::To(double seconds, const std::function<void(BodyKey&)>& edit) {
  edit(now);
  times_s_.push_back(times_s_.back() + seconds * tempo_ * Between(0.93, 1.07));
  keys_.push_back(ToNumbers(now));
}

void Moves::Hold(double seconds) {
  To(seconds, [](BodyKey&) {});
}

void Moves::Ease(double seconds) {
  To(seconds, [&](BodyKey& key) {
    BodyKey easy = ease_;
    easy.heading = key.heading;
    easy.pelvis_m.x() = 0.5 * (key.leg[0].foot_m.x() + key.leg[1].foot_m.x());
    easy.pelvis_m.z() = 0.5 * (key.leg[0].foot_m.z() + key.leg[1].foot_m.z());
    for (size_t s = 0; s < 2; ++s) {
      easy.leg[s] = key.leg[s];
      easy.leg[s].pitch = 0.0;
      easy.leg[s].knee = 0.0;
      easy.leg[s].foot_m.y() = 0.0;
    }
    key = easy;
  });
}

double Moves::Between(double low, double high) {
  // 53 random bits: the same on every machine, unlike the standard distributions.
  return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
}

double Moves::Size(double value) { return value * amplitude_ * Between(0.9, 1.1); }

bool Moves::Coin() { return Between(0.0, 1.0) < 0.5; }

int Moves::Count(int low, int high) {
  return std::min(high, low + static_cast<int>(Between(0.0, high - low + 1.0)));
}

BodyKeyNumbers Moves::At(double time_s) const {
  const size_t last = times_s_.size() - 1;
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  const size_t i = std::clamp<size_t>(static_cast<size_t>(after - times_s_.begin()), 1, last) - 1;
  const double h = times_s_[i + 1] - times_s_[i];
  const double t = std::clamp((time_s - times_s_[i]) / h, 0.0, 1.0);
  BodyKeyNumbers out{};
  for (size_t n = 0; n < out.size(); ++n) {
    const double p0 = keys_[i][n], p1 = keys_[i + 1][n], d = (p1 - p0) / h;
    double m0 = 0.0, m1 = 0.0;
    if (i > 0) {
      const double before = times_s_[i] - times_s_[i - 1];
      m0 = MonotoneSlope(before, (p0 - keys_[i - 1][n]) / before, h, d);
    }
    if (i + 1 < last) {
      const double next = times_s_[i + 2] - times_s_[i + 1];
      m1 = MonotoneSlope(h, d, next, (keys_[i + 2][n] - p1) / next);
    }
    const double t2 = t * t, t3 = t2 * t;
    out[n] = (2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * h * m0 + (3 * t2 - 2 * t3) * p1 +
             (t3 - t2) * h * m1;
  }
  return out;
}

BodyKey Moves::Swayed(BodyKeyNumbers numbers, double time_s) const {
  for (size_t n = 0; n < numbers.size(); ++n) {
    double wave = 0.0;
    for (size_t k = 0; k < kSwayHertz.size(); ++k) {
      wave += std::sin(2.0 * std::numbers::pi * kSwayHertz[k] * time_s + sway_phase_[n][k]) /
              static_cast<double>(k + 1);
    }
    numbers[n] += sway_ * kSway[n] * wave;
  }
  BodyKey key = ToKey(numbers);
  for (ArmKey& arm : key.arm) arm.reach = std::clamp(arm.reach, 0.15, 0.99);
  key.weight = std::clamp(key.weight, 0.0, 1.0);
  return mirrored_ ? Mirrored(key) : key;
}

std::vector<RigPose> Moves::Play(double frame_s) const {
  std::vector<RigPose> frames;
  const auto count = static_cast<size_t>(times_s_.back() / frame_s) + 1;
  for (size_t f = 0; f < count; ++f) {
    const double time_s = static_cast<double>(f) * frame_s;
    frames.push_back(ComputePose(Swayed(At(time_s), time_s)));
  }
  return frames;
}

Vector3d FootBeside(const BodyKey& ease, size_t side, const Vector3d& place_m, double heading) {
  const double angle = heading * std::numbers::pi / 180.0;
  const Vector3d& foot = ease.leg[side].foot_m;
  return place_m + Eigen::AngleAxisd(angle, Vector3d::UnitY()) * Vector3d(foot.x(), 0.0, foot.z());
}

namespace {

/// The body's path during a step.
class StepPath {
 public:
  StepPath(const BodyKey& from, const StepTo& step)
      : from_(from), step_(step), other_(1 - step.side), way_(step.foot_m - FootBefore()) {
    const double angle = step.heading * std::numbers::pi / 180.0;
    const Vector3d front(std::sin(angle), 0.0, std::cos(angle));
    stride_ = std::clamp(way_.dot(front) / 1.2, -0.3, 1.0);
    to_ = 0.5 * (step.foot_m + from.leg[other_].foot_m);
    to_.y() = from.pelvis_m.y();
    other_foot_heading_ = from.heading + OtherSign() * from.leg[other_].yaw;
  }

  /// 1 for a full stride forwards: heels rise and strike, arms swing, the pelvis rotates with the
  /// leg.
  double stride() const { return stride_; }
  /// Displacement of the stepping foot.
  const Vector3d& way() const { return way_; }
  const Vector3d& FootBefore() const { return from_.leg[step_.side].foot_m; }

  /// Moves pelvis and heading to `part` of the way. The standing foot keeps its direction while the
  /// body turns over it.
  void MoveBody(BodyKey& key, double part) const {
    key.balance = 0.0;
    key.pelvis_m = from_.pelvis_m + part * (to_ - from_.pelvis_m);
    key.heading = from_.heading + part * (step_.heading - from_.heading);
    key.leg[other_].yaw = OtherSign() * (other_foot_heading_ - key.heading);
  }

 private:
  double OtherSign() const { return other_ == 0 ? 1.0 : -1.0; }

  const BodyKey from_;
  const StepTo& step_;
  size_t other_;
  Vector3d way_;
  Vector3d to_;  // of the pelvis
  double stride_ = 0.0;
  double other_foot_heading_ = 0.0;  // world
};

}  // namespace

void Step(Moves& moves, const StepTo& step, const std::function<void(BodyKey&)>& arms) {
  const size_t other = 1 - step.side;
  const double side_sign = step.side == 0 ? 1.0 : -1.0;
  const StepPath path(moves.now, step);
  const double forwards = std::max(path.stride(), 0.0);
  moves.To(0.22 * step.seconds, [&](BodyKey& key) {
    path.MoveBody(key, 0.24);
    key.leg[other].pitch = 0.0;
    key.leg[step.side].pitch = 12.0 + 32.0 * forwards;
    key.roll = -side_sign * 1.5;
  });
  moves.To(0.4 * step.seconds, [&](BodyKey& key) {
    path.MoveBody(key, 0.62);
    const double angle = step.heading * std::numbers::pi / 180.0;
    const Vector3d sway =
        Eigen::AngleAxisd(angle, Vector3d::UnitY()) * Vector3d(-side_sign * 0.025, 0, 0);
    key.pelvis_m += sway;
    key.leg[step.side].foot_m = path.FootBefore() + 0.6 * path.way();
    key.leg[step.side].foot_m.y() = step.lift_m;
    key.leg[step.side].pitch = 14.0 * forwards;
    key.roll = -side_sign * 2.5;
  });
  moves.To(0.38 * step.seconds, [&](BodyKey& key) {
    path.MoveBody(key, 1.0);
    key.leg[step.side].foot_m = step.foot_m;
    key.leg[step.side].pitch = -17.0 * forwards;
    key.leg[step.side].yaw = moves.ease().leg[step.side].yaw;
    key.leg[other].pitch = 16.0 * forwards;
    key.twist = -side_sign * 7.0 * path.stride();
    key.turn = side_sign * 12.0 * path.stride();
    key.roll = 0.0;
    arms(key);
  });
}

}  // namespace ossa::recon
