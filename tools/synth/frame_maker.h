#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/body/clothing.h"
#include "tools/synth/dataset.h"
#include "tools/synth/pose_bank.h"
#include "tools/synth/props.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

// Constants: the sensor's own image is a Kinect v1's; people and seed by convention.

enum class SensorKind { kExact, kKinectV1 };
enum class Background { kNone, kRoom };

struct FrameOptions {
  int width = 640;
  int height = 480;
  View view = View::kFront;
  Split split = Split::kTrain;
  Occluders occluders = Occluders::kNone;
  SensorKind sensor = SensorKind::kKinectV1;
  /// kNone: pixels of nobody read 0, as after a perfect segmentation.
  Background background = Background::kNone;
  bool random_bodies = true;     // else everybody is the average body, lightly clothed
  bool generic_cameras = false;  // besides the Kinect's intrinsics, others
  bool sequence = false;         // the poses are consecutive frames of one clip before one camera
  int people = 1;
  uint64_t seed = 1;
  PoseVariation variation;
};

/// What all threads share while rendering.
struct FrameStudio {
  recon::BodyModel model;
  recon::Wardrobe wardrobe;
  std::vector<recon::RigPose> poses;
  FrameOptions options;

  FrameStudio(recon::BodyModel body, std::vector<recon::RigPose> bank, const FrameOptions& how)
      : model(std::move(body)), wardrobe(model), poses(std::move(bank)), options(how) {}
  FrameStudio(const FrameStudio&) = delete;  // the wardrobe points into the model
  FrameStudio& operator=(const FrameStudio&) = delete;
};

/// Makes labelled frames; one maker a thread. Frame i depends on the studio and i only.
class FrameMaker {
 public:
  explicit FrameMaker(const FrameStudio& studio);
  ~FrameMaker();

  LabelledFrame Make(int64_t index);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::tools
