#include <cmath>
#include <sstream>
#include <string>

#include "depth/sensor/source_internal.h"

namespace ossa::depth {

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
  return guess.camera;
}

}  // namespace ossa::depth
