#include "tools/tracker/frame_parts_internal.h"

#include <algorithm>

namespace ossa::tracker {

PartProbabilities ZeroProbabilities(const depth::DepthFrame& frame,
                                    const forest::ForestModel& model) {
  const auto pixels = static_cast<size_t>(frame.camera.width * frame.camera.height);
  return {frame.camera.width, frame.camera.height, model.class_count(),
          std::vector<float>(pixels * static_cast<size_t>(model.class_count()))};
}

void AddProbabilities(const forest::Classification& seen, PartProbabilities& probabilities) {
  const auto classes = static_cast<size_t>(probabilities.classes);
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    float* const of_pixel = &probabilities.data[static_cast<size_t>(seen.pixel[i]) * classes];
    for (size_t c = 0; c < classes; ++c) of_pixel[c] = seen.Probability(i, c);
  }
}

namespace {

// Part and probabilities of one pixel, where the frame has them.
void ClearPixel(size_t pixel, BodyFrame& frame) {
  const auto classes = static_cast<size_t>(frame.probabilities.classes);
  if (!frame.parts.data.empty()) frame.parts.data[pixel] = 0;
  if (frame.probabilities.data.empty()) return;
  std::fill_n(frame.probabilities.data.begin() + static_cast<std::ptrdiff_t>(pixel * classes),
              classes, 0.0F);
}

}  // namespace

void ClearParts(int id, BodyFrame& frame) {
  for (size_t p = 0; p < frame.users.data.size(); ++p) {
    if (frame.users.data[p] == id) ClearPixel(p, frame);
  }
}

void ClearHoles(const depth::DepthView& depth_mm, BodyFrame& frame) {
  for (size_t p = 0; p < frame.users.data.size(); ++p) {
    if (frame.users.data[p] == 0 || depth_mm.at(static_cast<int32_t>(p)) != 0) continue;
    frame.users.data[p] = 0;
    ClearPixel(p, frame);
  }
}

}  // namespace ossa::tracker
