#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "depth/render/sensor_model.h"
#include "recon/body/body_model.h"
#include "recon/body/clothing.h"
#include "tools/synth/dataset.h"
#include "tools/synth/pose_bank.h"
#include "tools/synth/props.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

// Constants: image size of a Kinect v1; people and seed by convention.

enum class Background { kNone, kRoom, kLivedIn };

struct FrameOptions {
  int width = 640;
  int height = 480;
  View view = View::kFront;
  Split split = Split::kTrain;
  Occluders occluders = Occluders::kNone;
  /// Each frame draws one of them.
  std::vector<depth::SensorKind> sensors = {depth::SensorKind::kKinectV1};
  /// kNone: only people and the objects labelled with them have depth, as after a perfect
  /// segmentation. kLivedIn: a room with shelves, coats on hooks, door frames and plants.
  Background background = Background::kNone;
  bool random_bodies = true;     // else all people have the average body and light clothes
  bool ends = false;             // one random body in three has an extreme shape
  bool hanging_clothes = false;  // also loose clothes, hats, bags and gloves
  Cameras cameras = Cameras::kKinectV1;
  double fov_deg = 0.0;   // horizontal field of view; 0: the Kinect's
  double shrink = 1.0;    // factor by definition: rendered larger, then shrunk by nearest neighbour
  bool sequence = false;  // the poses are consecutive frames of one clip, seen by one camera
  int people = 1;
  int views = 1;   // cameras around the people of a sequence
  int camera = 0;  // index of the camera that is rendered, from 0
  uint64_t seed = 1;
  PoseVariation variation;
};

/// The images' camera, after shrinking, unless each frame draws its own.
depth::Camera MakeCamera(const FrameOptions& options);

/// Inputs of rendering that all threads share: body model, clothes, poses, options.
struct FrameInputs {
  recon::BodyModel model;
  recon::Wardrobe wardrobe;
  std::vector<recon::RigPose> poses;
  FrameOptions options;

  FrameInputs(recon::BodyModel body, std::vector<recon::RigPose> bank, const FrameOptions& how)
      : model(std::move(body)), wardrobe(model), poses(std::move(bank)), options(how) {}
  FrameInputs(const FrameInputs&) = delete;  // the wardrobe points into the model
  FrameInputs& operator=(const FrameInputs&) = delete;
};

/// Renders labelled frames; one maker per thread. Frame i depends only on the inputs and i.
class FrameMaker {
 public:
  explicit FrameMaker(const FrameInputs& inputs);
  ~FrameMaker();

  /// Throws std::runtime_error if no drawn view shows a person.
  LabelledFrame Make(int64_t index);

  /// For a sequence, entry k transforms points from camera 0's space to camera k's.
  std::vector<Eigen::Isometry3d> FromCamera0();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::tools
