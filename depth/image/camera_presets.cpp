#include "depth/image/camera_presets.h"

#include <algorithm>
#include <array>

#include "depth/base/error.h"

// Constants: measured, as users' calibrations and data sheets have them; pixels.
namespace ossa::depth {
namespace {

// In the order of PresetCamera's values.
constexpr std::array<std::string_view, 14> kNames = {
    "kinect-v1",  "kinect-v2", "azure-nfov", "azure-wfov",      "xtion",           "d415",
    "d435",       "d455",      "femto",      "kinect-v1-color", "kinect-v2-color", "azure-color",
    "d415-color", "d435-color"};

// The same field of view in images of another width, with square pixels.
Camera ScaledByWidth(const Camera& whole, int width, int height) {
  const double scale = static_cast<double>(width) / whole.width;
  const double below_middle_px = scale * (whole.cy - whole.height / 2.0);
  return {width,
          height,
          scale * whole.fx,
          scale * whole.fy,
          scale * whole.cx,
          height / 2.0 + below_middle_px};
}

// Azure Kinect and Orbbec Femto have the same sensor of 1024 × 1024 pixels, f about 504. The wide
// field of view is all of it, the narrow one starts at (192, 180) (Azure Kinect SDK,
// mode_specific_calibration.c); both may be binned by 2. Pixel centres are integers.
Camera AzureCamera(bool wide, int width, int height) {
  constexpr double kFocal_px = 504.0;
  const Camera whole{1024, 1024, kFocal_px, kFocal_px, 511.5, 511.5};
  return ScaledByWidth(wide ? whole : Cropped(whole, 192, 180, 640, 576), width, height);
}

// A RealSense scales its sensor's image to cover the requested size, and crops the rest
// (rs-enumerate-devices -c of a D455: f 640 at 1280 x 720, 424 at 848 x 480, 384 at 640 x 480).
Camera RealSenseCamera(double focal_at_1280_px, int rows_at_1280, int width, int height) {
  const double scale = std::max(width / 1280.0, static_cast<double>(height) / rows_at_1280);
  const double f = focal_at_1280_px * scale;
  return {width, height, f, f, width / 2.0, height / 2.0};
}

// The colour camera of a D415 or D435: 1920 x 1080, scaled to the requested height, with its sides
// cropped (users' D435: f 918.6 at 1280 x 720, 612.4 at 640 x 480, 306.2 at 424 x 240 and 320 x
// 240; D415: 925.8 at 1280 x 720). A D455's has the same field of view as its depth.
Camera RealSenseColorCamera(int width, int height) {
  constexpr double kFocalPerHeight = 1.28;
  const double f = kFocalPerHeight * height;
  return {width, height, f, f, width / 2.0, height / 2.0};
}

bool IsAnyOf(int width, int height, std::initializer_list<std::array<int, 2>> sizes) {
  return std::find(sizes.begin(), sizes.end(), std::array{width, height}) != sizes.end();
}

// For images at least as wide as high.
Camera UprightCamera(std::string_view name, int width, int height) {
  const auto scaled = [&](const Camera& camera) { return ScaledByWidth(camera, width, height); };
  if (name == "kinect-v1") return KinectV1Camera(width, height);
  // Users' calibrations: f 364 to 367; the centre varies by some pixels.
  if (name == "kinect-v2") return scaled({512, 424, 366.0, 366.0, 256.0, 212.0});
  if (name == "azure-nfov") return AzureCamera(false, width, height);
  if (name == "azure-wfov") return AzureCamera(true, width, height);
  // OpenNI's field of view, 58.6 degrees.
  if (name == "xtion") return scaled({640, 480, 570.3, 570.3, 320.0, 240.0});
  // Intel's data sheet: 65 degrees horizontally; users' D435 and D455 have f 640.
  if (name == "d415") return RealSenseCamera(1005.0, 720, width, height);
  if (name == "d435" || name == "d455") return RealSenseCamera(640.0, 800, width, height);
  if (name == "femto") return AzureCamera(width == height, width, height);
  // OpenNI's depth registered to the colour camera.
  if (name == "kinect-v1-color") return scaled({640, 480, 525.0, 525.0, 320.0, 240.0});
  // Factory calibration (libfreenect2).
  if (name == "kinect-v2-color") return scaled({1920, 1080, 1081.4, 1081.4, 959.5, 539.5});
  // Users' calibrations: 0.473 to 0.479 of the width, whatever the shape.
  if (name == "azure-color") return scaled({1920, 1080, 916.0, 916.0, 959.5, 539.5});
  if (name == "d415-color" || name == "d435-color") return RealSenseColorCamera(width, height);
  std::string message =
      "--camera: expected fx,fy,cx,cy in pixels, FILE.json, FILE.yaml, FILE.xml, FILE.txt";
  for (const std::string_view known : kNames) message.append(", ").append(known);
  throw InputError(message + ", found '" + std::string(name) + "'");
}

// The preset with this image size; "" if there is none. width >= height.
std::string_view PresetOfSize(int width, int height) {
  if (IsAnyOf(width, height, {{640, 480}, {320, 240}, {160, 120}, {80, 60}})) return "kinect-v1";
  if (IsAnyOf(width, height, {{512, 424}})) return "kinect-v2";
  if (IsAnyOf(width, height, {{640, 576}, {320, 288}})) return "azure-nfov";
  if (IsAnyOf(width, height, {{512, 512}, {1024, 1024}})) return "azure-wfov";
  // Depth aligned to a colour image, full size or, as in ROS's iai_kinect2 (qhd), half size. Two
  // other cameras have images of the first size, with a wider and a narrower view.
  if (IsAnyOf(width, height, {{1920, 1080}, {960, 540}})) return "kinect-v2-color";
  if (IsAnyOf(width, height, {{2048, 1536}, {2560, 1440}, {3840, 2160}, {4096, 3072}})) {
    return "azure-color";
  }
  const bool is_real_sense = IsAnyOf(
      width, height, {{1280, 800}, {1280, 720}, {848, 480}, {640, 360}, {480, 270}, {424, 240}});
  return is_real_sense ? "d435" : "";
}

}  // namespace

std::span<const std::string_view> CameraPresetNames() { return kNames; }

Camera PresetCamera(std::string_view name, int width, int height) {
  if (height <= width) return UprightCamera(name, width, height);
  // Rotated to either side: the principal point is assumed in the middle, because the direction is
  // unknown.
  const double f = UprightCamera(name, height, width).fx;
  return {width, height, f, f, width / 2.0, height / 2.0};
}

CameraGuess GuessCamera(int width, int height) {
  const std::string_view preset = PresetOfSize(std::max(width, height), std::min(width, height));
  const std::string_view taken_for = preset.empty() ? kNames.front() : preset;
  return {taken_for, !preset.empty(), PresetCamera(taken_for, width, height)};
}

std::vector<CameraGuess> NarrowerCameras(int width, int height) {
  // By hand: people up to a fifth too large are recognised about as well.
  constexpr double kNarrower = 1.2;
  const CameraGuess guess = GuessCamera(width, height);
  std::vector<CameraGuess> cameras;
  const int longer = std::max(width, height), shorter = std::min(width, height);
  if (IsAnyOf(longer, shorter,
              {{1920, 1080}, {1280, 720}, {960, 540}, {848, 480}, {640, 360}, {424, 240}})) {
    constexpr std::string_view kColor = "d435-color";
    cameras.push_back({kColor, true, PresetCamera(kColor, width, height)});
  } else if (!guess.sizes_match) {
    const double f = KinectV1Camera(640, 480).fx / 480 * shorter;
    cameras.push_back({"", false, {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1)}});
  }
  std::erase_if(cameras, [&](const CameraGuess& other) {
    return other.camera.fx < kNarrower * guess.camera.fx;
  });
  return cameras;
}

Camera CameraForSize(const CameraChoice& choice, int width, int height) {
  if (!choice.preset.empty()) return PresetCamera(choice.preset, width, height);
  const Camera& camera = choice.camera;
  if (camera.width == width && camera.height == height) return camera;
  if (camera.width == 0) {
    return {width, height, camera.fx, camera.fy, camera.cx, camera.cy};
  }
  return Resized(camera, width, height);
}

}  // namespace ossa::depth
