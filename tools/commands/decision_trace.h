#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "depth/base/line_file.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {

/// The file of `ossa track --trace`: a JSON line per frame with all segments of the scene and the
/// rule that accepted or rejected each. It is complete or absent.
class DecisionTrace {
 public:
  /// `path` "" writes nothing. Throws InputError if the file cannot be written.
  explicit DecisionTrace(const std::string& path);
  /// Throws DiskFull.
  void Write(const tracker::BodyFrame& bodies);
  /// On a full disk keeps the complete frames; throws InputError that states their number.
  void Finish();

 private:
  std::optional<LineFile> file_;
  int64_t frames_ = 0;  // written
  std::optional<DiskFull> full_;
};

}  // namespace ossa::commands
