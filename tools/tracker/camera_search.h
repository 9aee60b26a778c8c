#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/camera_presets.h"
#include "depth/sensor/frame_source.h"
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

/// A camera that was taken in place of the one guessed by the images' size.
struct CameraFinding {
  depth::CameraGuess guess, found;
};

/// What a user reads of it, without the source's name.
std::string Describe(const CameraFinding& finding);
/// The camera as `--camera` takes it.
std::string CameraText(const depth::CameraGuess& camera);

/// Of a folder of images, or one, that states no camera: looks at some of its images for whether
/// one of depth::NarrowerCameras took them. Nothing where the guess stays, where there is no choice
/// and of other sources. `options` of the tracker are asked for where there is a choice; `idle`
/// returns false to end it. Throws InputError as depth::OpenSource does.
std::optional<CameraFinding> FindNarrowerCamera(
    const std::string& source, const depth::SourceOptions& options,
    const std::function<TrackerOptions()>& tracker_options, const std::function<bool()>& idle);

}  // namespace ossa::tracker
