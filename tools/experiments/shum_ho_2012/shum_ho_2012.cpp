// K. S. H. Shum & E. S. L. Ho, "Real-time physical modelling of character movements with Microsoft
// Kinect", VRST 2012: the scenes of sec. 8, the filter it becomes in Shum 2013, and fig. 5.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

#include "depth/base/error.h"
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/shum_ho_2012/internal.h"
#include "tools/experiments/simulation/motions.h"
#include "tools/experiments/simulation/recording_simulator.h"

namespace ossa::tools {
namespace {

struct Scene {
  const char* file;
  const char* title;
  double still;  // time of the still picture, as a share of the scene
  SceneResult (*play)(const ActionClips& clips, uint64_t seed);
};

constexpr std::array<Scene, 6> kScenes = {{
    {"carry", "lifting and carrying a bulky box (fig. 3a)", 0.85, CarryABox},
    {"boxes", "walking through, punching and kicking boxes (fig. 3b)", 0.88, WalkThroughBoxes},
    {"mace", "a mace on a hand (fig. 3c)", 0.18, SwingAMace},
    {"balls", "balls of random sizes (fig. 3d)", 0.5, MeetBalls},
    {"dodge", "dodging (figs. 3e, 4)", 0.7, Dodge},
    {"throw", "two characters throwing boxes (fig. 3f)", 0.45, ThrowBoxes},
}};

// Constants: of pictures, by eye.

constexpr int kPictureMs = 67;  // every second 30 Hz frame
constexpr int kStripPictures = 6;

// Bounds of parameters, by hand: a month; the smallest distance between different postures.
constexpr double kMost_hours = 720.0;  // hours
constexpr double kLeastThreshold_m = 0.01, kMostThreshold_m = 10.0;

/// The parts selected by the parameter `parts`; all by default.
std::set<std::string> Parts(Parameters& parameters) {
  std::vector<std::string> known;
  for (const Scene& scene : kScenes) known.emplace_back(scene.file);
  known.insert(known.end(), {"filter", "cost", "dimensions"});
  return parameters.Some("parts", known);
}

void PlayScene(const Scene& scene, const ExperimentContext& context, const ActionClips& clips,
               Table& table, std::vector<Picture>& stills) {
  const SceneResult result = scene.play(clips, context.seed);
  for (const SceneNumber& n : result.numbers) {
    table.rows.push_back({scene.title, n.what, n.value, n.wanted, n.good ? "yes" : "NO"});
  }
  WritePicture(context.out / (std::string(scene.file) + ".png"),
               Strip(result.pictures, kStripPictures));
  WriteAnimation(context.out / (std::string(scene.file) + "_animated.png"), result.pictures,
                 kPictureMs);
  const double last = static_cast<double>(result.pictures.size()) - 1.0;
  stills.push_back(result.pictures[static_cast<size_t>(scene.still * last)]);
}

Table SceneTable() {
  Table scenes;
  scenes.title = "Scenes of Shum & Ho 2012, sec. 8";
  scenes.columns = {"scene", "what", "measured", "wanted", "holds"};
  scenes.note =
      "Postures from ossa's authored clips instead of a user before a Kinect. Pictures: NAME.png "
      "(strip), NAME_animated.png (animated PNG); yellow lines are the postures asked for.";
  return scenes;
}

}  // namespace

ShumHoSettings ReadShumHoSettings(Parameters& parameters) {
  ShumHoSettings settings;
  settings.rendered = parameters.Flag("rendered", true);
  settings.rendered_frames = parameters.Integer("rendered_frames", 150, 2);
  settings.observer = ReadObserver(parameters);
  settings.filter_stride = parameters.Number("filter_stride", 16, 1);
  settings.endurance_hours = parameters.Number("endurance_hours", 0.1, 0, kMost_hours);
  settings.database_threshold_m =
      parameters.Number("database_threshold_m", 0.5, kLeastThreshold_m, kMostThreshold_m);
  return settings;
}

void ReadShumHo2012Parameters(ExperimentContext& context) {
  Parts(context.parameters);
  ReadShumHoSettings(context.parameters);
  ReadMotions(context);
}

std::vector<Table> RunShumHo2012(ExperimentContext& context) {
  const std::set<std::string> parts = Parts(context.parameters);
  if (parts.contains("filter") && !context.shared.empty()) {
    RequireRecordings(context.shared,
                      {RecordingSet::kUiPrmd, RecordingSet::kKeraal, RecordingSet::kItop});
  }
  const ActionClips clips(context.seed);
  double done = 0.0;
  const auto begin = [&](const std::string& part) {
    if (!parts.contains(part)) return false;
    context.ThrowIfInterrupted();
    if (context.progress) context.progress(done++, static_cast<double>(parts.size()), part);
    return true;
  };
  std::vector<Table> tables;
  Table scenes = SceneTable();
  std::vector<Picture> stills;
  for (const Scene& scene : kScenes) {
    if (begin(scene.file)) PlayScene(scene, context, clips, scenes, stills);
  }
  if (!stills.empty()) WritePicture(context.out / "scenes.png", Sheet(stills, 3));
  if (!scenes.rows.empty()) tables.push_back(scenes);
  if (begin("filter")) tables.push_back(FilterStudy(context, clips));
  if (begin("cost")) tables.push_back(CostStudy(context, clips));
  if (begin("dimensions")) tables.push_back(DimensionStudy(context));
  return tables;
}

}  // namespace ossa::tools
