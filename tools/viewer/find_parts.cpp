#include <map>
#include <vector>

#include "forest/classification/classify.h"
#include "tools/viewer/find_parts_internal.h"

namespace ossa::viewer {

depth::Image<uint8_t> FindParts(const forest::ForestModel& model, const depth::DepthFrame& frame,
                                const depth::Image<uint8_t>& users) {
  std::map<uint8_t, std::vector<int32_t>> pixels;  // of each person
  for (size_t i = 0; i < users.data.size(); ++i) {
    if (users.data[i] != 0) pixels[users.data[i]].push_back(static_cast<int32_t>(i));
  }
  depth::Image<uint8_t> parts(users.width, users.height);
  for (const auto& [id, of_person] : pixels) {
    const forest::Classification seen =
        forest::Classify(model, frame.view(), frame.camera, of_person, {});
    for (size_t i = 0; i < seen.label.size(); ++i) {
      parts.data[static_cast<size_t>(seen.pixel[i])] = seen.label[i];
    }
  }
  return parts;
}

}  // namespace ossa::viewer
