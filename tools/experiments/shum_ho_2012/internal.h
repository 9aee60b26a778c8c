#pragma once
#include <map>
#include <string>
#include <vector>

#include "physics/world.h"
#include "recon/body/rig.h"
#include "tools/experiments/experiment.h"
#include "tools/experiments/shum_ho_2012/scene_painter.h"
#include "tools/experiments/simulation/jobs.h"

namespace ossa::tools {

/// Authored motion by action: postures of the standard body, metres, feet on y = 0, facing +z.
class ActionClips {
 public:
  explicit ActionClips(uint64_t seed);
  /// The first clip of an action, e.g. "walk".
  const std::vector<recon::Posture>& Get(const std::string& action) const;
  std::vector<std::string> Actions() const;
  /// Actions in sequence; each starts where the last one ended and is blended in over a third of a
  /// second.
  std::vector<recon::Posture> Sequence(const std::vector<std::string>& actions) const;

 private:
  std::map<std::string, std::vector<recon::Posture>> clips_;
};

/// A running scene: the physical world, its pictures and measures.
class SceneSimulation {
 public:
  /// `draws`: whether pictures are made.
  SceneSimulation(uint64_t seed, const SceneView& view, bool draws = true);

  physics::World world;
  int AddPerson(const recon::Posture& start, const physics::CharacterOptions& options = {});
  /// Advances by a frame of 1/30 s: sets the characters' targets, steps the world, draws every
  /// second frame.
  void Advance(const std::vector<recon::Posture>& targets, const std::string& caption);

  /// True if an object touched one of the person's bones in the last frame. `bones`: end joints of
  /// bones; empty: all. `object` -1: any.
  bool IsStruck(int person, const std::vector<size_t>& bones, int object = -1) const;

  int frames() const { return frames_; }
  double deepest_m() const { return deepest_m_; }  // characters in objects
  double ms_per_frame() const { return frames_ == 0 ? 0.0 : simulated_ms_ / frames_; }
  const std::vector<Picture>& pictures() const { return pictures_; }

 private:
  SceneView view_;
  bool draws_;
  std::vector<Picture> pictures_;
  int frames_ = 0;
  double deepest_m_ = 0.0;
  double simulated_ms_ = 0.0;
};

struct SceneNumber {
  std::string what;
  std::string value;
  std::string wanted;
  bool good = true;
};

struct SceneResult {
  std::vector<SceneNumber> numbers;
  std::vector<Picture> pictures;
};

/// The paper's scenes (sec. 8.1-8.3, figs. 3 and 4).
SceneResult CarryABox(const ActionClips& clips, uint64_t seed);
SceneResult WalkThroughBoxes(const ActionClips& clips, uint64_t seed);
SceneResult SwingAMace(const ActionClips& clips, uint64_t seed);
SceneResult MeetBalls(const ActionClips& clips, uint64_t seed);
SceneResult Dodge(const ActionClips& clips, uint64_t seed);
SceneResult ThrowBoxes(const ActionClips& clips, uint64_t seed);

/// Adds the numbers and pictures that all scenes share: contact depth, processor time.
void AddCommonNumbers(const SceneSimulation& simulation, SceneResult& result);
std::string Text(double value, int digits, const std::string& unit);

/// Settings of the studies below, except the motions of rendered scenes (ReadMotions()).
struct ShumHoSettings {
  bool rendered = true;  // also filters rendered scenes
  int rendered_frames = 0;
  std::string observer;
  double filter_stride = 0.0;         // every n-th sequence of UI-PRMD is filtered
  double endurance_hours = 0.0;       // of simulated time
  double database_threshold_m = 0.0;  // recon::DatabaseOptions::threshold_m
};
ShumHoSettings ReadShumHoSettings(Parameters& parameters);

/// The character as a filter of noisy authored motion and, if available, of real recordings.
Table FilterStudy(ExperimentContext& context, const ActionClips& clips);
/// Processor time of a frame: one person, six, one among many boxes.
Table CostStudy(ExperimentContext& context, const ActionClips& clips);
/// Fig. 5: error of the matched posture and time of a query against the number of PCA dimensions.
Table DimensionStudy(ExperimentContext& context);

}  // namespace ossa::tools
