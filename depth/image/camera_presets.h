#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

/// The cameras that people own, by the names that `--camera` takes. Those in -color are of depth
/// that was aligned to the images of the camera's colour sensor.
std::span<const std::string_view> CameraPresetNames();

/// The depth camera of that name for images of this size, by its maker's or its users' figures (an
/// own calibration is better by some pixels). Pixels are square: images of another shape than the
/// maker's are as wide a view, those higher than wide of a camera on its side. Throws InputError
/// for a name that is none of them.
Camera PresetCamera(std::string_view name, int width, int height);

/// Whose images have this size; the camera is that preset's.
struct CameraGuess {
  std::string_view preset;
  bool sizes_match = true;  // false: no known camera has such images; taken for a Kinect v1
  Camera camera;
};
CameraGuess GuessCamera(int width, int height);

/// Cameras that also have images of this size, of so much narrower a view than the guess's that
/// its people would be far too large: colour cameras that depth was aligned to, and, of a size that
/// no camera has, a part of a Kinect v1's image as high as it (`preset` is empty). Often none.
std::vector<CameraGuess> NarrowerCameras(int width, int height);

/// What somebody wants the camera to be: a preset's name, or a camera. One of width and height 0 is
/// in pixels of whatever images come.
struct CameraChoice {
  CameraChoice(const Camera& chosen) : camera(chosen) {}  // NOLINT: a camera is a choice
  explicit CameraChoice(std::string_view name) : preset(name) {}

  std::string preset;  // "": the camera
  Camera camera;
  std::string unheeded;  // what a file states of it besides, for people; mostly ""
};

/// The choice for images of this size: a camera without a size is taken as it is, another scaled.
Camera CameraForSize(const CameraChoice& choice, int width, int height);

}  // namespace ossa::depth
