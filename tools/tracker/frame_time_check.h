#pragma once
#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ossa::tracker {

/// Detects frame times that are not seconds, such as milliseconds: as seconds they would end every
/// track at every frame, without an error. Detects a wrong frame rate, too: images at five frames a
/// second that are taken for thirty show people who walk six times too fast.
class FrameTimeCheck {
 public:
  /// Adds the time of the next frame.
  void Add(double time_s);
  /// Adds where people are in the frame that was added last: by id, camera space, metres.
  void AddPeople(std::map<int, Eigen::Vector3d> positions_m);
  /// What is wrong with the times, for one line to the user; once, after the frame that decides.
  std::optional<std::string> TakeWarning();

 private:
  void JudgeSpeeds();

  std::optional<double> last_s_;
  std::vector<double> steps_s_;  // between the first frames; empty once they were judged
  bool judged_ = false;
  std::map<int, Eigen::Vector3d> people_m_;  // in the last frame with positions
  std::optional<double> people_s_;           // time of people_m_
  std::vector<double> speeds_mps_;  // of the people, from frame to frame, until they were judged
  bool speeds_judged_ = false;
  std::optional<std::string> warning_;
};

}  // namespace ossa::tracker
