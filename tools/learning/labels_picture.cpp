#include "tools/learning/labels_picture.h"

#include <algorithm>

#include "depth/image/colour_png.h"
#include "forest/classification/classify.h"
#include "recon/body/parts.h"
#include "tools/learning/person_source.h"

namespace ossa::tools {
namespace {

constexpr size_t kPanels = 3;  // depth, truth, model: by definition

// Three images of one size in a row, black at first.
class Panels {
 public:
  explicit Panels(const depth::Camera& camera)
      : width_(static_cast<size_t>(camera.width)),
        height_(static_cast<size_t>(camera.height)),
        samples_(3 * kPanels * width_ * height_, 0) {}

  void Set(size_t panel, size_t pixel, const recon::Rgb& colour) {
    const size_t column = panel * width_ + pixel % width_;
    uint8_t* sample = &samples_[3 * (pixel / width_ * kPanels * width_ + column)];
    sample[0] = colour.r;
    sample[1] = colour.g;
    sample[2] = colour.b;
  }
  std::vector<uint8_t> Encode() const {
    return depth::EncodeColourPng(
        samples_, {static_cast<int>(kPanels * width_), static_cast<int>(height_)}, 3);
  }

 private:
  size_t width_, height_;
  std::vector<uint8_t> samples_;
};

// The nearer, the brighter; 0 stays black.
recon::Rgb Grey(uint16_t depth_mm) {
  constexpr int kNearest_mm = 500, kFarthest_mm = 5000;  // by eye: where people stand
  if (depth_mm == 0) return {};
  const int mm = std::clamp<int>(depth_mm, kNearest_mm, kFarthest_mm);
  const auto grey =
      static_cast<uint8_t>(235 - 190 * (mm - kNearest_mm) / (kFarthest_mm - kNearest_mm));
  return {grey, grey, grey};
}

}  // namespace

std::vector<uint8_t> PictureOf(const forest::ForestModel& model, const LabelledFrame& frame) {
  Panels panels(frame.depth.camera);
  for (size_t i = 0; i < frame.depth.depth_mm.size(); ++i) {
    panels.Set(0, i, Grey(frame.depth.depth_mm[i]));
    if (frame.parts.data[i] != 0) panels.Set(1, i, recon::PartColour(frame.parts.data[i]));
  }
  for (const TruthBody& body : frame.bodies) {
    const forest::TrainingImage image = PersonImage(frame, body);
    std::vector<int32_t> pixels;
    for (size_t i = 0; i < image.label.size(); ++i) {
      if (image.label[i] != 0) pixels.push_back(static_cast<int32_t>(i));
    }
    if (pixels.empty()) continue;
    const int width = image.camera.width;
    const depth::DepthView view{image.depth_mm.data(), width, image.camera.height, width};
    const forest::Classification result = forest::Classify(model, view, image.camera, pixels);
    for (size_t i = 0; i < result.pixel.size(); ++i) {
      panels.Set(2, static_cast<size_t>(result.pixel[i]), recon::PartColour(result.label[i]));
    }
  }
  return panels.Encode();
}

}  // namespace ossa::tools
