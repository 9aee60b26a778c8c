#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "depth/base/random.h"
#include "depth/image/camera.h"

namespace ossa::tools {

/// `ossa render --view`: front: facing the camera within 60°, whole body mostly in view, 1.5-4
/// m; near: 0.7-1.7 m, cropped by the image; any: every side, height, distance and crop.
enum class View { kFront, kNear, kAny };
std::optional<View> ViewFromName(std::string_view name);

/// Train and test draw from disjoint sets of camera placements (and of body shapes).
enum class Split { kTrain, kTest };
std::optional<Split> SplitFromName(std::string_view name);

struct ViewRequest {
  View view = View::kAny;
  Split split = Split::kTrain;
  int width = 640;
  int height = 480;
  double person_height_m = 1.7;
  bool generic_cameras = true;  // besides the Kinect's intrinsics, others of like field of view
};

/// A camera and a person before it. World: y up, floor at y = 0, the person stands over the origin.
struct ViewSample {
  depth::Camera camera;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  /// Heading of the person, radians about y: 0 faces the camera, positive turns to the person's
  /// left.
  double facing_rad = 0.0;
};

ViewSample SampleView(const ViewRequest& request, Random& random);

}  // namespace ossa::tools
