#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/camera_presets.h"
#include "depth/sensor/frame_source.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Selects the camera model of images without stated intrinsics. A camera with a narrower view than
/// assumed makes people appear too large for the forest, whose confidence drops; one with a wider
/// view makes them appear small, like children, whose confidence stays high. So the first camera is
/// kept unless a narrower one raises the confidence clearly.
class CameraSearch {
 public:
  /// The first camera is the default. Throws as Tracker does.
  CameraSearch(std::vector<depth::Camera> cameras, TrackerOptions options);

  /// Tracks an image with each camera.
  void AddImage(depth::DepthFrame frame);
  /// Enough images with people were tracked.
  bool is_sure() const { return images_ >= kEnough; }
  /// Index of the selected camera.
  size_t Best() const;

 private:
  static constexpr int kEnough = 8;  // images; by hand

  std::vector<depth::Camera> cameras_;
  std::vector<double> confidence_sum_;  // mean trunk confidence of each camera, summed over images
  int images_ = 0;                      // images with people
  Tracker tracker_;
};

/// A camera that replaces the default for the images' size.
struct CameraFinding {
  depth::CameraGuess guess, found;
};

/// The message for the user, without the source's name.
std::string Describe(const CameraFinding& finding);
/// The camera as `--camera` takes it.
std::string CameraText(const depth::CameraGuess& camera);

/// For a folder of images, or one image, without a stated camera: whether one of
/// depth::NarrowerCameras took them, by some of its images. Empty if the default is kept, if there
/// is no alternative, and for other sources. `tracker_options` is called only if there is an
/// alternative; `idle` ends the search by returning false. Throws InputError as depth::OpenSource
/// does.
std::optional<CameraFinding> FindNarrowerCamera(
    const std::string& source, const depth::SourceOptions& options,
    const std::function<TrackerOptions()>& tracker_options, const std::function<bool()>& idle);

}  // namespace ossa::tracker
