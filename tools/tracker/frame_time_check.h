#pragma once
#include <optional>
#include <string>
#include <vector>

namespace ossa::tracker {

/// Detects frame times that are not seconds, such as milliseconds: as seconds they would end every
/// track at every frame, without an error.
class FrameTimeCheck {
 public:
  /// Adds the time of the next frame.
  void Add(double time_s);
  /// What is wrong with the times, for one line to the user; once, after the frame that decides.
  std::optional<std::string> TakeWarning();

 private:
  std::optional<double> last_s_;
  std::vector<double> steps_s_;  // between the first frames; empty once they were judged
  bool judged_ = false;
  std::optional<std::string> warning_;
};

}  // namespace ossa::tracker
