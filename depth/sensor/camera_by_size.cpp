#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>

#include "depth/image/turn.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {

Camera ChosenCamera(const SourceOptions& options, int width, int height) {
  const Camera camera = CameraForSize(*options.camera, width, height);
  const bool is_preset = !options.camera->preset.empty();
  return is_preset && options.mirrored ? Unmirrored(camera) : camera;
}

namespace {

// Whether an image may be a Kinect v1's, enlarged or made smaller. One of another shape is of a
// camera with another field of view, in which people would have another size.
bool HasKinectShape(int width, int height) {
  constexpr int kAcross = 4, kDown = 3;  // a ratio, by definition of 640x480
  const int longer = std::max(width, height), shorter = std::min(width, height);
  return std::abs(kDown * longer - kAcross * shorter) <= kAcross;  // rounded
}

}  // namespace

Camera CameraByImageSize(const std::string& name, int width, int height,
                         const SourceOptions& options) {
  const CameraGuess guess = GuessCamera(width, height);
  if (options.note) {
    std::ostringstream text;
    text << name << ": no camera is stated; " << guess.preset << " (f "
         << std::lround(guess.camera.fx) << " px) is assumed for images of " << width << "x"
         << height << (guess.sizes_match ? "" : ", the size of no known camera")
         << ": --camera sets another (-color: depth aligned to colour images)";
    const bool may_be_right = guess.sizes_match || HasKinectShape(width, height);
    options.note(may_be_right ? NoteKind::kInfo : NoteKind::kWarning, text.str());
  }
  if (options.guessed) options.guessed(guess);
  return options.mirrored ? Unmirrored(guess.camera) : guess.camera;
}

}  // namespace ossa::depth
