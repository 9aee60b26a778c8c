#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>

#include "recon/body/standard_body.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {

// Constants: of the scenes that are played, by hand.

using recon::Posture;

ActionClips::ActionClips(uint64_t seed) {
  recon::MocapOptions options;
  options.seed = seed;
  for (const recon::MotionClip& clip : recon::LoadMocap({"authored"}, options)) {
    // authored/ACTION/N
    const size_t begin = clip.name.find('/') + 1;
    const std::string action = clip.name.substr(begin, clip.name.rfind('/') - begin);
    if (clips_.contains(action)) continue;
    std::vector<Posture>& postures = clips_[action];
    for (const recon::RigPose& pose : clip.frames) postures.push_back(recon::StandardPosture(pose));
  }
}

const std::vector<Posture>& ActionClips::Get(const std::string& action) const {
  const auto found = clips_.find(action);
  if (found == clips_.end()) throw std::invalid_argument("no authored action " + action);
  return found->second;
}

std::vector<std::string> ActionClips::Actions() const {
  std::vector<std::string> names;
  for (const auto& [name, clip] : clips_) names.push_back(name);
  return names;
}

std::vector<Posture> ActionClips::Sequence(const std::vector<std::string>& actions) const {
  constexpr size_t kJoin = 10;
  std::vector<Posture> result;
  for (const std::string& action : actions) {
    const std::vector<Posture>& clip = Get(action);
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    if (!result.empty()) {
      shift = result.back().position_m[0] - clip.front().position_m[0];
      shift.y() = 0.0;
    }
    const Posture last = result.empty() ? clip.front() : result.back();
    for (size_t f = 0; f < clip.size(); ++f) {
      const double share = result.empty() || f >= kJoin ? 1.0 : static_cast<double>(f + 1) / kJoin;
      Posture posture;
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        posture.position_m[j] = (1.0 - share) * last.position_m[j] +
                                share * Eigen::Vector3d(clip[f].position_m[j] + shift);
      }
      result.push_back(posture);
    }
  }
  return result;
}

namespace {

physics::WorldOptions OptionsWithSeed(uint64_t seed) {
  physics::WorldOptions options;
  options.seed = seed;
  return options;
}

}  // namespace

SceneSimulation::SceneSimulation(uint64_t seed, const SceneView& view, bool draws)
    : world(OptionsWithSeed(seed)), view_(view), draws_(draws) {
  world.SetFloor(Eigen::Vector4d(0.0, 1.0, 0.0, 0.0));
}

int SceneSimulation::AddPerson(const Posture& start, const physics::CharacterOptions& options) {
  return world.AddCharacter(recon::MeasureBoneLengths(start), start, options);
}

bool SceneSimulation::IsStruck(int person, const std::vector<size_t>& bones, int object) const {
  const auto& struck = world.Contacts().struck;
  return std::any_of(struck.begin(), struck.end(), [&](const physics::Strike& s) {
    const bool bone = bones.empty() || std::find(bones.begin(), bones.end(), s.bone) != bones.end();
    return s.character == person && bone && (object < 0 || s.object == object);
  });
}

void SceneSimulation::Advance(const std::vector<Posture>& targets, const std::string& caption) {
  for (size_t c = 0; c < targets.size(); ++c) world.SetTarget(static_cast<int>(c), targets[c]);
  const double start_ms = ProcessorTime_ms();
  world.Step(1.0 / 30.0);
  simulated_ms_ += ProcessorTime_ms() - start_ms;
  deepest_m_ = std::max(deepest_m_, world.Contacts().character_object_depth_m);
  const bool picture = draws_ && frames_ % 2 == 0;
  ++frames_;
  if (picture) pictures_.push_back(Paint(world, view_, {targets, caption}));
}

std::string Text(double value, int digits, const std::string& unit) {
  return fmt::format("{:.{}f}{}{}", value, digits, unit.empty() ? "" : " ", unit);
}

void AddCommonNumbers(const SceneSimulation& simulation, SceneResult& result) {
  result.numbers.push_back({"deepest overlap of a limb and an object",
                            Text(1e3 * simulation.deepest_m(), 1, "mm"), "<= 5 mm",
                            simulation.deepest_m() <= 0.005});
  result.numbers.push_back({"processor time per 30 Hz frame",
                            Text(simulation.ms_per_frame(), 2, "ms"), "real time: < 33 ms",
                            simulation.ms_per_frame() < 33.0});
  bool finite = true;
  for (int c = 0; c < simulation.world.CharacterCount(); ++c)
    finite &= simulation.world.IsFinite(c);
  result.numbers.push_back({"characters whole at the end", finite ? "yes" : "no", "yes", finite});
  result.pictures = simulation.pictures();
}

}  // namespace ossa::tools
