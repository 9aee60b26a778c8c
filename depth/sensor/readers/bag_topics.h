#pragma once
#include <string>
#include <vector>

namespace ossa::depth {

struct BagTopic {
  std::string name, type;
};

/// The topics of a bag to read.
struct BagChoice {
  std::string image;
  std::string camera_info;         // "": there is none
  bool is_info_own = false;        // belongs to the image's sensor, so its distortion applies
  std::string unit;                // the RealSense viewer's depth units; "": there are none
  std::vector<std::string> notes;  // for the user, about ambiguous choices
};

/// `depth`: topics of 16-bit or metric images. If none is requested, those with "depth" in the name
/// are preferred, then the shortest name. Throws InputError naming the available topics.
BagChoice ChooseDepthTopic(const std::vector<std::string>& depth,
                           const std::vector<BagTopic>& topics, const std::string& asked);

}  // namespace ossa::depth
