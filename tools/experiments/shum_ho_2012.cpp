// K. S. H. Shum & E. S. L. Ho, "Real-time physical modelling of character movements with Microsoft
// Kinect", VRST 2012: the scenes of sec. 8, the filter it becomes in Shum 2013, and fig. 5.
#include <array>

#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/shum_ho_2012_internal.h"

namespace ossa::tools {
namespace {

struct Scene {
  const char* file;
  const char* title;
  SceneResult (*play)(const Actors& actors, uint64_t seed);
};

constexpr std::array<Scene, 6> kScenes = {{
    {"carry", "lifting and carrying a bulky box (fig. 3a)", CarryABox},
    {"boxes", "walking through, punching and kicking boxes (fig. 3b)", WalkThroughBoxes},
    {"mace", "a mace on a hand (fig. 3c)", SwingAMace},
    {"balls", "balls of random sizes (fig. 3d)", MeetBalls},
    {"dodge", "dodging (figs. 3e, 4)", Dodge},
    {"throw", "two characters throwing boxes (fig. 3f)", ThrowBoxes},
}};

constexpr int kPictureMs = 67;  // every second 30 Hz frame
constexpr int kStripPictures = 6;

}  // namespace

std::vector<Table> RunShumHo2012(ExperimentContext& context) {
  const Actors actors(context.seed);
  Table scenes;
  scenes.title = "Scenes of Shum & Ho 2012, sec. 8";
  scenes.columns = {"scene", "what", "measured", "wanted", "holds"};
  scenes.note =
      "Postures from ossa's authored clips instead of a user before a Kinect. Pictures: NAME.png "
      "(strip), NAME_animated.png (animated PNG); yellow lines are the postures asked for.";
  double done = 0.0;
  for (const Scene& scene : kScenes) {
    if (context.interrupted && context.interrupted()) throw Interruption();
    if (context.progress) context.progress(done++, kScenes.size() + 2, scene.file);
    const SceneResult result = scene.play(actors, context.seed);
    for (const SceneNumber& n : result.numbers) {
      scenes.rows.push_back({scene.title, n.what, n.value, n.wanted, n.good ? "yes" : "NO"});
    }
    WritePicture(context.out / (std::string(scene.file) + ".png"),
                 Strip(result.pictures, kStripPictures));
    WriteAnimation(context.out / (std::string(scene.file) + "_animated.png"), result.pictures,
                   kPictureMs);
  }
  if (context.progress) context.progress(done++, kScenes.size() + 2, "filter");
  Table filter = FilterStudy(context, actors);
  if (context.progress) context.progress(done++, kScenes.size() + 2, "fig. 5");
  return {scenes, filter, DimensionStudy(context)};
}

}  // namespace ossa::tools
