#pragma once
#include <stdexcept>

namespace ossa {

/// Thrown by training when its caller asked it to stop.
struct TrainInterrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace ossa
