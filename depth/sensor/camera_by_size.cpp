#include <cmath>
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

Camera CameraByImageSize(const std::string& name, int width, int height,
                         const SourceOptions& options) {
  const CameraGuess guess = GuessCamera(width, height);
  if (options.note) {
    std::ostringstream text;
    text << name << ": no camera is stated; images of " << width << "x" << height
         << (guess.sizes_match ? " are taken for a " : " are of no camera known, and taken for a ")
         << guess.preset << "'s (f " << std::lround(guess.camera.fx)
         << " px): --camera says otherwise (-color: depth aligned to colour images)";
    options.note(NoteKind::kInfo, text.str());
  }
  if (options.guessed) options.guessed(guess);
  return options.mirrored ? Unmirrored(guess.camera) : guess.camera;
}

}  // namespace ossa::depth
