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

// Constants: the sensor's own image is a Kinect v1's; people and seed by convention.

enum class Background { kNone, kRoom, kLivedIn };

struct FrameOptions {
  int width = 640;
  int height = 480;
  View view = View::kFront;
  Split split = Split::kTrain;
  Occluders occluders = Occluders::kNone;
  /// One of them in each frame, drawn where there are several.
  std::vector<depth::SensorKind> sensors = {depth::SensorKind::kKinectV1};
  /// kNone: pixels of nobody read 0, as after a perfect segmentation. kLivedIn: a room with
  /// shelves, coats on hooks, door frames and plants.
  Background background = Background::kNone;
  bool random_bodies = true;     // else everybody is the average body, lightly clothed
  bool ends = false;             // random bodies also from the ends of the range
  bool hanging_clothes = false;  // what hangs and folds, hats and bags, too
  Cameras cameras = Cameras::kKinectV1;
  double fov_deg = 0.0;   // horizontal field of view; 0: the Kinect's
  double shrink = 1.0;    // factor by definition: so much larger, then shrunk by nearest pixel
  bool sequence = false;  // the poses are consecutive frames of one clip before one camera
  int people = 1;
  int views = 1;   // cameras around the people of a sequence, of which
  int camera = 0;  // ... this one takes the images; counts from 0
  uint64_t seed = 1;
  PoseVariation variation;
};

/// The camera of the options' images where none is drawn for each frame, shrunk if they are.
depth::Camera MakeCamera(const FrameOptions& options);

/// What all threads share while rendering.
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

/// Makes labelled frames; one maker a thread. Frame i depends on the inputs and i only.
class FrameMaker {
 public:
  explicit FrameMaker(const FrameInputs& inputs);
  ~FrameMaker();

  LabelledFrame Make(int64_t index);

  /// Of a sequence: takes a point of camera 0's space to the space of the camera of each index.
  std::vector<Eigen::Isometry3d> FromCamera0();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::tools
