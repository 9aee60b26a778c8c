#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "depth/base/random.h"
#include "depth/image/camera.h"

namespace ossa::tools {

/// `ossa render --view`. Front: facing the camera within 60°, the whole body mostly in view, at
/// 1.6-4 m; near: at 0.75-1.7 m, cropped by the image; any: every side, height and crop, at
/// 0.8-5 m. Distances are on the floor, from the person's vertical axis. Ceiling: a camera 2.2 to 4
/// m above the floor that looks down.
enum class View { kFront, kNear, kAny, kCeiling };
std::optional<View> ViewFromName(std::string_view name);
std::string_view NameOf(View view);

/// Train and test draw from disjoint sets of camera placements and of body shapes.
enum class Split { kTrain, kTest };
std::optional<Split> SplitFromName(std::string_view name);

/// `ossa render --camera`: the Kinect v1's intrinsics; these and others with a similar field of
/// view; or images 100 to 1280 pixels wide, 45° to 120°, of several aspect ratios, some of them
/// shrunk.
enum class Cameras { kKinectV1, kGeneric, kAny };
std::optional<Cameras> CamerasFromName(std::string_view name);

struct ViewRequest {
  View view = View::kAny;
  Split split = Split::kTrain;
  int width = 640;
  int height = 480;
  double person_height_m = 1.7;
  Cameras cameras = Cameras::kGeneric;
  double fov_deg = 0.0;  // horizontal field of view of Cameras::kKinectV1; 0: the Kinect's
  double shrink = 1.0;   // factor >= 1: rendered larger, then shrunk by nearest neighbour
};

/// The camera of Cameras::kKinectV1 before shrinking.
depth::Camera PlainCamera(const ViewRequest& request);
/// The camera of an image shrunk by nearest neighbour.
depth::Camera ShrunkCamera(const depth::Camera& camera, double shrink);

/// A camera and the heading of a person. World: metres, y up, floor at y = 0, the person at the
/// origin.
struct ViewSample {
  depth::Camera camera;  // before shrinking
  double shrink = 1.0;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  /// Heading of the person, radians about y: 0 faces the camera, positive turns to the person's
  /// left.
  double facing_rad = 0.0;
};

ViewSample SampleView(const ViewRequest& request, Random& random);

}  // namespace ossa::tools
