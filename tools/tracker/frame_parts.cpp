#include "tools/tracker/frame_parts_internal.h"

#include <algorithm>

namespace ossa::tracker {

PartProbabilities NobodyIn(const depth::DepthFrame& frame, const forest::ForestModel& model) {
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

void ClearParts(int id, BodyFrame& frame) {
  const auto classes = static_cast<size_t>(frame.probabilities.classes);
  for (size_t p = 0; p < frame.users.data.size(); ++p) {
    if (frame.users.data[p] != id) continue;
    if (!frame.parts.data.empty()) frame.parts.data[p] = 0;
    if (!frame.probabilities.data.empty()) {
      std::fill_n(frame.probabilities.data.begin() + static_cast<std::ptrdiff_t>(p * classes),
                  classes, 0.0F);
    }
  }
}

}  // namespace ossa::tracker
