#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "depth/base/line_file.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {

/// The file of `ossa track --trace`: a JSON line a frame, with every piece of the scene and the
/// rule that decided whether it is a person. It appears at the end.
class DecisionTrace {
 public:
  /// "" writes nothing. Throws InputError where the file cannot be written.
  explicit DecisionTrace(const std::string& path);
  /// Throws DiskFull.
  void Write(const tracker::BodyFrame& bodies);
  /// Of what did not fit, what was whole before it: throws InputError that says how much.
  void Finish();

 private:
  std::optional<LineFile> file_;
  int64_t frames_ = 0;  // that are in it
  std::optional<DiskFull> full_;
};

}  // namespace ossa::commands
