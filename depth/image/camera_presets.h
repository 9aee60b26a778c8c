#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

/// Names of the camera presets, as `--camera` takes them. Those that end in -color are for depth
/// that was aligned to the images of the camera's colour sensor.
std::span<const std::string_view> CameraPresetNames();

/// The intrinsics of a preset for images of this size, from published figures (a calibration is
/// more accurate by some pixels). Pixels are square: images of another aspect ratio have the same
/// horizontal field of view; images higher than wide are those of the camera on its side. Throws
/// InputError for an unknown name.
Camera PresetCamera(std::string_view name, int width, int height);

/// The preset whose images have this size, with its camera.
struct CameraGuess {
  std::string_view preset;
  bool sizes_match = true;  // false: no known camera has this size; a Kinect v1 is assumed
  Camera camera;
};
CameraGuess GuessCamera(int width, int height);

/// Other cameras with images of this size whose field of view is so much narrower that people would
/// come out far too large with the guess: colour cameras to which depth was aligned and, for sizes
/// of no known camera, a crop of a Kinect v1's image (`preset` is empty). Often none.
std::vector<CameraGuess> NarrowerCameras(int width, int height);

/// A camera as a user gives it: a preset's name, or intrinsics. With width and height 0 these are
/// for images of any size.
struct CameraChoice {
  CameraChoice(const Camera& chosen) : camera(chosen) {}  // NOLINT: a camera is a choice
  explicit CameraChoice(std::string_view name) : preset(name) {}

  std::string preset;  // "": the camera
  Camera camera;
  std::string unheeded;  // what of a file was ignored, as a note for the user; mostly ""
};

/// The chosen camera for images of this size: scaled, unless it has no size.
Camera CameraForSize(const CameraChoice& choice, int width, int height);

}  // namespace ossa::depth
