#include "tools/synth/view_sampler.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "depth/base/angles.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand unless stated otherwise.

/// Position and direction of the camera.
struct Placement {
  double distance_m = 2.5;    // on the floor, from the person's vertical axis
  double height_m = 1.0;      // of the camera
  double aim_height_m = 0.9;  // height at which the optical axis meets the person's axis
  double aside_rad = 0.0;     // moves the person sideways in the image
  double roll_rad = 0.0;
  double facing_rad = 0.0;
  double aim_ahead_m = 0.0;  // of the person's axis, towards the camera
  double beside_m = 0.0;     // camera and aim, to the person's left
};

/// Test placements are one in five cells of a grid over height, distance and heading; training
/// draws from the other four.
bool IsTestPlacement(const Placement& place) {
  const auto cell = [](double value, double size) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(value / size)) + 1000);
  };
  const uint64_t key = (cell(place.height_m, 0.1) * 4096 + cell(place.distance_m, 0.1)) * 4096 +
                       cell(place.facing_rad, 10 * kDegree);
  return Random(key, 0).Index(5) == 0;
}

Placement DrawFront(double person_m, Random& random) {
  Placement place;
  place.distance_m = random.Uniform(1.6, 4.0);
  place.height_m = random.Uniform(0.4, 2.0);
  // Near people fill the image and are centred; far people are anywhere in it.
  const double slack = std::clamp((place.distance_m - 2.0) / 2.0, 0.0, 1.0);
  place.aim_height_m = person_m * (0.52 + random.Uniform(-0.2, 0.2) * (0.3 + slack));
  place.aside_rad = random.Uniform(-14, 14) * kDegree * (0.4 + 0.6 * slack);
  place.facing_rad = random.Uniform(-60, 60) * kDegree;
  return place;
}

Placement DrawNear(double person_m, Random& random) {
  Placement place;
  place.distance_m = random.Uniform(0.75, 1.7);
  place.height_m = person_m * random.Uniform(0.45, 1.15);
  place.aim_height_m = person_m * random.Uniform(0.55, 0.95);
  place.aside_rad = random.Uniform(-16, 16) * kDegree;
  place.facing_rad =
      random.Chance(0.8) ? random.Uniform(-60, 60) * kDegree : random.Uniform(-180, 180) * kDegree;
  return place;
}

Placement DrawAny(double person_m, Random& random) {
  Placement place;
  // Uniform in the logarithm: as many near views as far ones.
  place.distance_m = 0.8 * std::pow(5.0 / 0.8, random.Uniform(0.0, 1.0));
  place.height_m = random.Uniform(0.3, 2.4);
  place.aim_height_m = person_m * random.Uniform(0.2, 0.9);
  place.aside_rad = random.Uniform(-24, 24) * kDegree;
  place.facing_rad = random.Uniform(-180, 180) * kDegree;
  return place;
}

/// A camera under the ceiling that looks straight down or tilted, the person anywhere in the image.
/// If it looks almost straight down it has any rotation about its axis, else the far side is up.
Placement DrawCeiling(double person_m, Random& random) {
  constexpr double kMostTilt_deg = 35.0, kTurnedAnyhow_deg = 10.0;  // from straight down
  constexpr double kMiddle = 0.55;  // height of the body's centre, share of its height
  constexpr double kAcross = 0.38, kDown = 0.32;  // about half the image's size over its distance
  constexpr double kLeastAside_m = 0.01;          // straight down has no heading
  Placement place;
  place.height_m = random.Uniform(2.2, 4.0);
  const double tilt_deg = random.Uniform(0.0, kMostTilt_deg);
  place.aim_height_m = person_m * kMiddle;
  const double reach_m = place.height_m - place.aim_height_m;
  place.beside_m = reach_m * random.Uniform(-kAcross, kAcross);
  place.aim_ahead_m = reach_m * random.Uniform(-kDown, kDown);
  place.distance_m =
      place.aim_ahead_m + std::max(kLeastAside_m, reach_m * std::tan(tilt_deg * kDegree));
  place.roll_rad = tilt_deg < kTurnedAnyhow_deg ? random.Uniform(-180, 180) * kDegree : 0.0;
  place.facing_rad = random.Uniform(-180, 180) * kDegree;
  return place;
}

Placement Draw(View view, double person_m, Random& random) {
  Placement place = view == View::kFront     ? DrawFront(person_m, random)
                    : view == View::kNear    ? DrawNear(person_m, random)
                    : view == View::kCeiling ? DrawCeiling(person_m, random)
                                             : DrawAny(person_m, random);
  place.roll_rad += random.Normal(0.0, 2.0 * kDegree);
  return place;
}

/// The camera of any sensor: size, aspect ratio, field of view, and shrinking.
void DrawAnyCamera(ViewSample* sample, Random& random) {
  constexpr double kLeast_px = 100.0, kMost_px = 1280.0;
  constexpr double kNarrow_deg = 45.0, kWide_deg = 120.0;
  constexpr double kShapes[] = {3.0 / 4, 3.0 / 4, 1.0, 9.0 / 16, 0.9};  // height over width
  constexpr double kShrunkShare = 0.4, kMostShrunk = 4.0;               // of images; factor
  const double width_px = kLeast_px * std::pow(kMost_px / kLeast_px, random.Unit());
  const double shape = kShapes[random.Index(std::size(kShapes))];
  const double fov_deg = random.Uniform(kNarrow_deg, kWide_deg);
  const bool shrunk = random.Chance(kShrunkShare);
  const double shrink = random.Uniform(1.0, kMostShrunk);
  sample->shrink = shrunk ? std::min(shrink, kMost_px / width_px) : 1.0;
  ViewRequest request;
  request.width = static_cast<int>(width_px);
  request.height = static_cast<int>(width_px * shape);
  request.fov_deg = fov_deg;
  request.shrink = sample->shrink;
  sample->camera = PlainCamera(request);
}

void DrawCamera(const ViewRequest& request, ViewSample* sample, Random& random) {
  if (request.cameras == Cameras::kAny) return DrawAnyCamera(sample, random);
  depth::Camera& camera = sample->camera;
  camera = PlainCamera(request);
  sample->shrink = request.shrink;
  if (request.cameras == Cameras::kKinectV1 || random.Chance(0.5)) return;
  const double zoom = random.Uniform(0.85, 1.15);
  camera.fx *= zoom;
  camera.fy *= zoom * random.Uniform(0.99, 1.01);
  camera.cx += random.Normal(0.0, 0.01) * camera.width;
  camera.cy += random.Normal(0.0, 0.01) * camera.height;
}

/// A camera on the person's +z side that looks at the aim point, turned sideways and rolled.
Eigen::Isometry3d CameraFromWorld(const Placement& place) {
  const Eigen::Vector3d position_m(place.beside_m, place.height_m, place.distance_m);
  const Eigen::Vector3d aim_m(place.beside_m, place.aim_height_m, place.aim_ahead_m);
  const Eigen::Vector3d forward = (aim_m - position_m).normalized();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY().cross(forward).normalized();
  Eigen::Matrix3d world_from_camera;
  world_from_camera << left, forward.cross(left), forward;
  world_from_camera = world_from_camera *
                      Eigen::AngleAxisd(place.aside_rad, Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(place.roll_rad, Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = world_from_camera;
  pose.translation() = position_m;
  return pose.inverse();
}

}  // namespace

std::optional<View> ViewFromName(std::string_view name) {
  if (name == "front") return View::kFront;
  if (name == "near") return View::kNear;
  if (name == "any") return View::kAny;
  if (name == "ceiling") return View::kCeiling;
  return std::nullopt;
}

std::string_view NameOf(View view) {
  switch (view) {
    case View::kFront:
      return "front";
    case View::kNear:
      return "near";
    case View::kCeiling:
      return "ceiling";
    case View::kAny:
      break;
  }
  return "any";
}

std::optional<Cameras> CamerasFromName(std::string_view name) {
  if (name == "kinect-v1") return Cameras::kKinectV1;
  if (name == "generic") return Cameras::kGeneric;
  if (name == "any") return Cameras::kAny;
  return std::nullopt;
}

depth::Camera PlainCamera(const ViewRequest& request) {
  const auto larger = [&](int side) {
    return static_cast<int>(std::lround(side * request.shrink));
  };
  depth::Camera camera = depth::KinectV1Camera(larger(request.width), larger(request.height));
  if (request.fov_deg > 0.0) {
    camera.fx = camera.fy = 0.5 * camera.width / std::tan(0.5 * request.fov_deg * kDegree);
  }
  return camera;
}

depth::Camera ShrunkCamera(const depth::Camera& camera, double shrink) {
  if (shrink == 1.0) return camera;
  const auto smaller = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(side / shrink)));
  };
  // On average over the rounding, pixel u shows pixel (u + 1/2) shrink - 1/2 of the large image.
  return {.width = smaller(camera.width),
          .height = smaller(camera.height),
          .fx = camera.fx / shrink,
          .fy = camera.fy / shrink,
          .cx = (camera.cx + 0.5) / shrink - 0.5,
          .cy = (camera.cy + 0.5) / shrink - 0.5};
}

std::optional<Split> SplitFromName(std::string_view name) {
  if (name == "train") return Split::kTrain;
  if (name == "test") return Split::kTest;
  return std::nullopt;
}

ViewSample SampleView(const ViewRequest& request, Random& random) {
  Placement place = Draw(request.view, request.person_height_m, random);
  while (IsTestPlacement(place) != (request.split == Split::kTest)) {
    place = Draw(request.view, request.person_height_m, random);
  }
  ViewSample sample;
  DrawCamera(request, &sample, random);
  sample.camera_from_world = CameraFromWorld(place);
  sample.facing_rad = place.facing_rad;
  return sample;
}

}  // namespace ossa::tools
