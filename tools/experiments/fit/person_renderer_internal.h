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

/// A rendered person, 1.1 to 2.1 m tall.
struct RenderedPerson {
  double target_m = 0.0;  // stature of the table row, metres
  recon::BodyShape shape;
  double stature_m = 0.0;  // barefoot, without hair
  uint64_t seed = 0;       // of clothes, place and noise
};

/// Renders sequences of people of known stature in an empty room, as a Kinect v1 sees them.
class PersonRenderer {
 public:
  static constexpr int kFrames = 90;  // by definition of the study: 3 s at 30 Hz

  /// `per_height` people of each of about 1.1, 1.2, ... 2.1 m. `train_shapes`: of the shapes for
  /// training, else of those for tests. Throws InputError if the body model is missing.
  PersonRenderer(ExperimentContext& context, int per_height, bool train_shapes);
  ~PersonRenderer();

  const std::vector<RenderedPerson>& people() const { return people_; }
  /// The person's frames with true joints and parts. `loose`: in a coat, a skirt or other loose
  /// clothes.
  std::vector<LabelledFrame> RenderClip(const RenderedPerson& person, bool loose) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<RenderedPerson> people_;
};

/// Number of people of each height, and whether they have the shapes kept for training.
struct FitSettings {
  int people_per_height = 0, start_people_per_height = 0, shape_people_per_height = 0;
  bool train_shapes = false;
};
FitSettings ReadFitSettings(Parameters& parameters);

/// Errors and estimated standard deviations of stature and joints, in ordinary and in loose
/// clothes.
std::vector<Table> FitPeople(ExperimentContext& context);
/// Basin of convergence: errors of the initial joints from which the fit converges.
std::vector<Table> FitStarts(ExperimentContext& context);
/// Effect of fitting with the shape of another person.
std::vector<Table> FitWrongShapes(ExperimentContext& context);

}  // namespace ossa::tools
