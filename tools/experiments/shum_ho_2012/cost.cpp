// Processor time of the character (Shum & Ho 2012, sec. 8.4: 0.55 ms a frame on an i7-2600K), and
// an endurance run of ten hours: random clips, pushes and dropped frames.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <random>

#include "depth/base/statistics.h"
#include "physics/character_filter.h"
#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {
namespace {

using Eigen::Vector3d;
using recon::Posture;

constexpr double kFrame_s = 1.0 / 30.0;  // 30 Hz, a Kinect SDK's rate

/// Milliseconds of processor time a frame: median and mean over the frames.
struct Cost {
  double median_ms, mean_ms;
};

Cost MeasureCost(const std::vector<Posture>& motion, int people, physics::Control control) {
  std::vector<physics::CharacterFilter> filters;
  physics::CharacterFilterOptions options;
  options.control = control;
  for (int k = 0; k < people; ++k) {
    filters.emplace_back(recon::MeasureBoneLengths(motion[0]), options);
  }
  const Eigen::Vector4d floor(0.0, 1.0, 0.0, 0.0);
  std::vector<double> ms;
  for (size_t f = 0; f < motion.size(); ++f) {
    const double start_ms = ProcessorTime_ms();
    for (size_t k = 0; k < filters.size(); ++k) {
      filters[k].Step(motion[(f + 37 * k) % motion.size()], {}, floor, kFrame_s);
    }
    ms.push_back(ProcessorTime_ms() - start_ms);
  }
  Cost cost{0.0, 0.0};
  for (const double m : ms) cost.mean_ms += m / static_cast<double>(ms.size());
  cost.median_ms = ossa::Median(std::move(ms));
  return cost;
}

/// The result of an endurance run.
struct Endurance {
  int64_t frames = 0, lost = 0;
  int rescued = 0;  // resets by the world because the state was not finite
  double farthest_m = 0.0, fastest_m_s = 0.0, deepest_m = 0.0;
};

/// Random clips at random places, pushes of up to 100 Ns on the trunk, missing and absurd joints
/// and frames. `lost` counts the frames after a second of good targets in which the character is
/// not within 25 cm of them.
class EnduranceRun {
 public:
  EnduranceRun(const Posture& first, uint64_t seed) : random_(seed), before_(first) {
    world_.SetFloor(Eigen::Vector4d(0.0, 1.0, 0.0, 0.0));
    person_ = world_.AddCharacter(recon::MeasureBoneLengths(first), first);
  }

  void Play(const std::vector<Posture>& clip, int64_t most_frames) {
    place_ = 0.9 * (place_ + Vector3d(Draw(), 0.0, 0.0));
    place_ += Vector3d(0.0, 0.0, 0.9 * Draw());
    good_ = 0;  // a new clip starts elsewhere
    for (size_t f = 0; f < clip.size() && found_.frames < most_frames; ++f) {
      Posture target = clip[f];
      for (auto& p : target.position_m) p += place_;
      Frame(target);
    }
  }
  size_t Pick(size_t count) { return random_() % count; }
  const Endurance& found() const { return found_; }

 private:
  double Draw() { return uniform_(random_); }

  void Frame(Posture target) {
    const double luck = Draw();
    ++good_;
    if (luck > 0.98) Push();
    if (luck < -0.94) Corrupt(target, luck > -0.96);
    const bool dropped =
        luck > 0.9 && luck < 0.94;  // no frame arrives: the next step is twice as long
    const double dt_s = dropped ? 2 * kFrame_s : kFrame_s;
    world_.SetTarget(person_, target);
    world_.Step(dt_s);
    CheckState(target, dt_s);
  }

  void Push() {
    const size_t joint = Pick(recon::kJointCount);
    // Impulse of a shove for the trunk, of a ball for a limb of a kilogram.
    const double most_ns = joint <= 4 || joint % 4 == 0 ? 60.0 : 6.0;
    Vector3d impulse_ns;
    for (double& v : impulse_ns) v = most_ns * Draw();
    world_.ApplyImpulse(person_, static_cast<recon::Joint>(joint), impulse_ns);
    good_ = 0;
  }

  void Corrupt(Posture& target, bool absurd) {
    for (auto& p : target.position_m) {
      if (absurd) {
        p = Vector3d(1e3 * Draw(), 1e3, 1e3);
      } else if (Draw() > 0.0) {
        p.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
    good_ = 0;
  }

  void CheckState(const Posture& target, double dt_s) {
    const auto state = world_.StateOf(person_);
    ++found_.frames;
    found_.rescued = state.rescued;
    double far = 0.0;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const Vector3d& at = state.posture.position_m[j];
      far += (at - target.position_m[j]).norm() / recon::kJointCount;
      found_.fastest_m_s = std::max(found_.fastest_m_s, (at - before_.position_m[j]).norm() / dt_s);
    }
    before_ = state.posture;
    if (good_ > 30) {
      found_.farthest_m = std::max(found_.farthest_m, far);
      if (!(far < 0.25)) ++found_.lost;
    }
    found_.deepest_m = std::max(found_.deepest_m, world_.Contacts().floor_depth_m);
  }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  physics::World world_;
  int person_ = 0;
  int good_ = 0;  // frames in a row with complete targets and no push
  Posture before_;
  Vector3d place_ = Vector3d::Zero();
  Endurance found_;
};

Endurance RunEndurance(const ActionClips& clips, double hours, const ExperimentContext& context) {
  const std::vector<std::string> actions = clips.Actions();
  EnduranceRun run(clips.Get(actions[0])[0], context.seed);
  const auto wanted = static_cast<int64_t>(hours * 3600.0 / kFrame_s);
  while (run.found().frames < wanted) {
    context.ThrowIfInterrupted();
    run.Play(clips.Get(actions[run.Pick(actions.size())]), wanted);
  }
  return run.found();
}

}  // namespace

Table CostStudy(ExperimentContext& context, const ActionClips& clips) {
  Table table;
  table.title = "What the character costs and stands";
  table.columns = {"what", "measured", "wanted", "holds"};
  const auto& motion = clips.Get("tai_chi");
  const auto row = [&](const std::string& what, const std::string& value, const std::string& wanted,
                       bool good) {
    table.rows.push_back({what, value, wanted, good ? "yes" : "NO"});
  };
  for (const auto& [name, control] :
       {std::pair("pd", physics::Control::kPaper), {"motor", physics::Control::kMotor}}) {
    const Cost one = MeasureCost(motion, 1, control), six = MeasureCost(motion, 6, control);
    const auto text = [](const Cost& c) {
      return fmt::format("{:.2f} ms median, {:.2f} mean", c.median_ms, c.mean_ms);
    };
    row(fmt::format("one person, 30 Hz frame of 10 substeps, {}", name), text(one), "<= 0.6 ms",
        one.median_ms <= 0.6);
    row(fmt::format("six people, {}", name), text(six), "<= 4 ms", six.median_ms <= 4.0);
  }
  const double hours = ReadShumHoSettings(context.parameters).endurance_hours;
  const double start_ms = ProcessorTime_ms();
  const Endurance e = RunEndurance(clips, hours, context);
  row(fmt::format("{:g} hours of clips, pushes, bad and dropped frames: not finite", hours),
      fmt::format("{} of {} frames, in {:.0f} s", e.rescued, e.frames,
                  1e-3 * (ProcessorTime_ms() - start_ms)),
      "0", e.rescued == 0);
  row("character lost: > 25 cm off after a second of good targets", std::to_string(e.lost), "0",
      e.lost == 0);
  row("farthest off then, joints' mean", fmt::format("{:.1f} cm", 100 * e.farthest_m), "< 25 cm",
      e.farthest_m < 0.25);
  row("fastest joint", fmt::format("{:.1f} m/s", e.fastest_m_s), "< 40 m/s", e.fastest_m_s < 40.0);
  row("deepest in the floor", fmt::format("{:.1f} mm", 1e3 * e.deepest_m), "<= 5 mm",
      e.deepest_m <= 0.005);
  return table;
}

}  // namespace ossa::tools
