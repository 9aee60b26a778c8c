#include <algorithm>
#include <cmath>

#include "depth/render/shapes.h"
#include "recon/body/clothing.h"
#include "tools/experiments/fit/person_renderer_internal.h"
#include "tools/experiments/simulation/motions.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/sample_person.h"
#include "tools/synth/sequence_poses.h"

namespace ossa::tools {
namespace {

// Constants: of what is rendered, by hand.

constexpr double kLeast_m = 1.1, kStep_m = 0.1;  // 1.1 to 2.1 m, by definition of the study
constexpr size_t kHeights = 11;
constexpr uint64_t kDraws = 1500;  // shapes, enough for each height

// The drawn people nearest to each height.
std::vector<RenderedPerson> ChoosePeople(const recon::BodyModel& model, Split split, int per_height,
                                         uint64_t seed) {
  std::vector<RenderedPerson> drawn, chosen;
  for (uint64_t k = 0; k < kDraws; ++k) {
    Random random(seed, k);
    const recon::BodyShape shape = SampleAnyShape(split, random);
    drawn.push_back({0.0, shape, model.Shape(shape).height_m, k});
  }
  for (size_t h = 0; h < kHeights; ++h) {
    const double target_m = kLeast_m + kStep_m * static_cast<double>(h);
    std::stable_sort(drawn.begin(), drawn.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.stature_m - target_m) < std::abs(b.stature_m - target_m);
    });
    for (size_t i = 0; i < static_cast<size_t>(per_height); ++i) {
      chosen.push_back(drawn[i]);
      chosen.back().target_m = target_m;
    }
  }
  return chosen;
}

}  // namespace

struct PersonRenderer::State {
  recon::BodyModel model = LoadFetchedBody();
  recon::Wardrobe wardrobe{model};
  std::vector<recon::MotionClip> clips;
};

PersonRenderer::PersonRenderer(ExperimentContext& context, int per_height, bool train_shapes)
    : state_(std::make_unique<State>()) {
  state_->clips =
      AuthoredMotions(context, {"stand", "walk", "wave", "talk", "squat", "raise_arms"}, 2);
  people_ = ChoosePeople(state_->model, train_shapes ? Split::kTrain : Split::kTest, per_height,
                         context.seed);
}
PersonRenderer::~PersonRenderer() = default;

std::vector<LabelledFrame> PersonRenderer::RenderClip(const RenderedPerson& person,
                                                      bool loose) const {
  constexpr double kHeight_m = 1.0, kNearest_m = 3.0, kFarthest_m = 3.8, kAside_rad = 0.6;
  Random random(person.seed, 7);
  recon::Clothing clothing = SampleClothing(random);
  while (loose && clothing.hang == 0.0) clothing = SampleHangingClothing(random);
  const double away_m = random.Uniform(kNearest_m, kFarthest_m);
  const double azimuth_rad = random.Uniform(-kAside_rad, kAside_rad);
  const Eigen::Isometry3d camera_from_world = LookAt(
      {away_m * std::sin(azimuth_rad), kHeight_m, away_m * std::cos(azimuth_rad)}, {0.0, 0.9, 0.0});
  const recon::MotionClip& clip = state_->clips[person.seed % state_->clips.size()];
  std::vector<ClothedBody> bodies;
  bodies.emplace_back(state_->model, state_->wardrobe, person.shape, clothing);
  depth::Renderer renderer;
  bodies[0].AddTo(renderer);
  const Eigen::Affine3f to_camera(camera_from_world.matrix().cast<float>());
  renderer.AddMesh(depth::Moved(depth::MakeRoom({7.0F, 3.0F, 8.0F}), to_camera), false);
  std::vector<LabelledFrame> frames;
  for (const recon::RigPose& pose : SequencePoses({clip}, kFrames, person.seed)) {
    const recon::Posture joints_m = bodies[0].Pose(pose, camera_from_world);
    bodies[0].UpdateMesh(renderer);
    frames.push_back(RenderBodies(renderer, depth::KinectV1Camera(320, 240), state_->model, bodies,
                                  person.seed * 1000003 + frames.size()));
    frames.back().depth.index = static_cast<int64_t>(frames.size() - 1);
    frames.back().depth.time_s = static_cast<double>(frames.size() - 1) / 30.0;
    frames.back().bodies.push_back({1, joints_m, {}});
  }
  return frames;
}

}  // namespace ossa::tools
