#pragma once
#include <stdexcept>
#include <string>

namespace ossa {

/// Bad input from outside: a file, a device, a value the user gave. The message names the file, the
/// place in it (byte, line or field), what was expected and what was found, in one line.
/// All readers throw this and nothing else for bad input.
class InputError : public std::runtime_error {
 public:
  /// `message` may quote a hostile file: line breaks and control characters in it are escaped
  /// (one_line.h).
  explicit InputError(const std::string& message);
};

}  // namespace ossa
