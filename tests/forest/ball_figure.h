#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "depth/image/depth_frame.h"
#include "forest/training/train.h"

namespace ossa::forest::test {

/// A figure of five balls, rotated about the vertical: 1 belly, 2 head, 3 left hand, 4 right hand,
/// and 5 a nose, the only cue to front and back. Contexts: 0 faces the camera, 1 shows its back.
/// Targets: the centres of the head and of the two hands.
class BallFigures final : public TrainingSource {
 public:
  BallFigures(size_t count, uint64_t seed, int width = 128)
      : count_(count), seed_(seed), width_(width) {}

  size_t size() const override { return count_; }
  TrainingImage Read(size_t index) const override;

 private:
  size_t count_;
  uint64_t seed_;
  int width_;
};

/// Twenty of them, each changed in the same way.
class ChangedFigures final : public TrainingSource {
 public:
  using Change = std::function<void(TrainingImage&)>;
  explicit ChangedFigures(Change change) : change_(std::move(change)) {}

  size_t size() const override { return figures_.size(); }
  TrainingImage Read(size_t index) const override {
    TrainingImage image = figures_.Read(index);
    change_(image);
    return image;
  }

 private:
  BallFigures figures_{20, 3};
  Change change_;
};

TrainingVocabulary BallVocabulary();

/// Small and quick options.
TrainOptions QuickOptions();

/// The model of 800 figures, trained once a test program.
const ForestModel& BallModel();

/// Pixels of an image's object.
std::vector<int32_t> ObjectPixels(const TrainingImage& image);

/// Depth view of a training image.
inline depth::DepthView MakeView(const TrainingImage& image) {
  return {image.depth_mm.data(), image.camera.width, image.camera.height, image.camera.width};
}

/// The bytes of the model's file.
std::vector<char> ToBytes(const ForestModel& model);

}  // namespace ossa::forest::test
