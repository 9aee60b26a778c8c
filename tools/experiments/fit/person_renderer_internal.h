#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/body/rig.h"
#include "tools/experiments/experiment.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Somebody who is rendered: of the shapes kept for tests, from 1.1 to 2.1 m tall.
struct RenderedPerson {
  double target_m = 0.0;  // of the row in tables
  recon::BodyShape shape;
  double stature_m = 0.0;  // barefoot, without hair
  uint64_t seed = 0;       // of clothes, place and noise
};

/// Renders people of known stature in motion before a simulated Kinect v1 in an empty room.
class PersonRenderer {
 public:
  static constexpr int kFrames = 90;  // by definition of the question that is asked: 3 s at 30 Hz

  /// `per_height` people about 1.1, 1.2, ... 2.1 m tall. Throws InputError where the body was not
  /// fetched.
  PersonRenderer(ExperimentContext& context, int per_height, bool train_shapes);
  ~PersonRenderer();

  const std::vector<RenderedPerson>& people() const { return people_; }
  /// The person's frames with the true joints and parts; `loose`: in a coat, a skirt or what hangs.
  std::vector<LabelledFrame> RenderClip(const RenderedPerson& person, bool loose) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<RenderedPerson> people_;
};

/// How many people are rendered of each height, and whether of the shapes kept for training.
struct FitSettings {
  int people_per_height = 0, start_people_per_height = 0, shape_people_per_height = 0;
  bool train_shapes = false;
};
FitSettings ReadFitSettings(Parameters& parameters);

/// Stature and joints with their error bars, as people are and in loose clothes.
std::vector<Table> FitPeople(ExperimentContext& context);
/// How far off joints may be to begin with.
std::vector<Table> FitStarts(ExperimentContext& context);
/// People who are taken for others, of other shapes.
std::vector<Table> FitWrongShapes(ExperimentContext& context);

}  // namespace ossa::tools
