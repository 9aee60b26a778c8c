#pragma once
#include <vector>

#include "depth/image/camera.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Which of several cameras took images that do not say it. A camera whose view is narrower than
/// was thought shows people too large for the forest, which is then unsure of them; one whose view
/// is wider shows them small, as children are, which it is not. So the first camera is taken unless
/// one of a narrower view makes people much surer.
class CameraSearch {
 public:
  /// The first camera is the one to take where nothing speaks against it. Throws as Tracker does.
  CameraSearch(std::vector<depth::Camera> cameras, TrackerOptions options);

  /// Looks at an image as each camera would have taken it.
  void Look(depth::DepthFrame frame);
  /// Enough people were seen.
  bool is_sure() const { return looks_ >= kEnough; }
  /// Index of the camera to take.
  size_t Best() const;

 private:
  static constexpr int kEnough = 8;  // images; by hand

  std::vector<depth::Camera> cameras_;
  std::vector<double> surety_;  // of each camera, summed over images
  int looks_ = 0;               // images with anybody in them
  Tracker tracker_;
};

}  // namespace ossa::tracker
