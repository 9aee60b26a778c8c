#pragma once
#include <stdexcept>
#include <string>

namespace ossa {

/// Bad input from outside: a file, a device, a value the user gave. The message names the file, the
/// place in it (byte, line or field), what was expected and what was found, in one line.
/// Every reader of every room throws this and nothing else for bad input.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ossa
