#include "tools/learning/labels_picture.h"

#include <algorithm>

#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "forest/proposals/relabel.h"
#include "tools/learning/person_source.h"
#include "tools/synth/contact_sheet.h"

namespace ossa::tools {
namespace {

// Labels of each person's pixels after relabelling, as counted by ossa evaluate.
depth::Image<uint8_t> LabelPixels(const forest::ForestModel& model, const LabelledFrame& frame) {
  depth::Image<uint8_t> labels = frame.parts;
  std::fill(labels.data.begin(), labels.data.end(), uint8_t{0});
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
    const auto proposals = forest::Propose(model, view, image.camera, result);
    const std::vector<uint8_t> label =
        forest::Relabel(model, view, image.camera, result, proposals);
    for (size_t i = 0; i < result.pixel.size(); ++i) {
      labels.data[static_cast<size_t>(result.pixel[i])] = label[i];
    }
  }
  return labels;
}

}  // namespace

std::vector<uint8_t> DrawPanels(const forest::ForestModel& model, const LabelledFrame& frame) {
  ContactSheet sheet(3, 3, frame.depth.camera.width, frame.depth.camera.height);
  sheet.Draw(0, frame.depth, {});
  sheet.Draw(1, {}, frame.parts);
  sheet.Draw(2, {}, LabelPixels(model, frame));
  return sheet.EncodePng();
}

}  // namespace ossa::tools
