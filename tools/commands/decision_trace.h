#pragma once
#include <optional>
#include <string>

#include "depth/base/atomic_file.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {

/// The file of `ossa track --trace`: a JSON line a frame, with every piece of the scene and the
/// rule that decided whether it is a person. It appears only when complete.
class DecisionTrace {
 public:
  /// "" writes nothing. Throws InputError where the file cannot be written.
  explicit DecisionTrace(const std::string& path);
  void Write(const tracker::BodyFrame& bodies);
  void Finish();

 private:
  std::optional<AtomicFile> file_;
};

}  // namespace ossa::commands
