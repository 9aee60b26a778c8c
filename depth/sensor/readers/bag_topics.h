#pragma once
#include <string>
#include <vector>

namespace ossa::depth {

struct BagTopic {
  std::string name, type;
};

/// Which of a bag's topics are read.
struct BagChoice {
  std::string image;
  std::string camera_info;         // "": there is none
  bool is_info_own = false;        // of the image's sensor, whose lens it states
  std::string unit;                // the RealSense viewer's depth units; "": there are none
  std::vector<std::string> notes;  // for the user, where there was a choice
};

/// `depth`: topics of 16-bit or metric images. Without one asked for, those that are named after
/// depth go before others, then the shortest name. Throws InputError naming what there is.
BagChoice ChooseDepthTopic(const std::vector<std::string>& depth,
                           const std::vector<BagTopic>& topics, const std::string& asked);

}  // namespace ossa::depth
