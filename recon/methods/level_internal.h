#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <deque>
#include <memory>
#include <optional>

#include "recon/methods/reconstructor.h"

namespace ossa::recon {

// Constants: by hand unless stated otherwise.

/// When the camera counts as tilted, and by what evidence.
struct LevelOptions {
  // Smaller tilts count as level: they change no method's error, and neither a floor plane nor a
  // standing body is much more accurate.
  double floor_least_deg = 3.0, body_least_deg = 8.0;
  double change_deg = 4.0;  // a tilt that differs by more is adopted: the camera was moved
  double most_deg = 40.0;   // largest tilt of a floor or of a standing body
  int floor_frames = 5;     // consecutive frames with that tilt: one may be a table
  // Of a standing body: largest angle of thighs, shanks and trunk to the line of balance, averaged
  // over half a second, in which noise and steps cancel. Seated people lean more.
  double most_bent_deg = 40.0;
  // Both feet carry weight, and are so close that the body cannot be balanced over one of them.
  double most_raised_m = 0.12, most_apart_m = 0.45;
  int fewest_frames = 15;  // of a standing or walking body, half a second
  int memory_frames = 90;  // three seconds; people sway and lean
};

/// Mean of both sides of a person, metres.
struct Stance {
  // From the middle of the feet to the centre of mass.
  Eigen::Vector3d balance_m = Eigen::Vector3d::Zero();
  // Each from lower to upper end.
  Eigen::Vector3d trunk_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d thighs_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d shanks_m = Eigen::Vector3d::Zero();
};

/// Estimates the up direction in the camera's space: from the floor, if known, else from the
/// person, whose centre of mass is above the feet, or they would fall. The papers assume a level
/// camera: their placement, database and upright test allow rotations about the vertical only.
class LevelEstimator {
 public:
  explicit LevelEstimator(const LevelOptions& options = {}) : options_(options) {}
  /// Transforms points from camera space to a level space with y up; none while the camera counts
  /// as level. Constant between frames until the tilt changes; the person's position is kept.
  const std::optional<Eigen::Isometry3d>& Update(const TrackedPosture& observed,
                                                 const std::optional<Eigen::Vector4d>& floor);
  void Reset() { *this = LevelEstimator(options_); }

 private:
  /// Whether a floor of that tilt has been seen for long enough.
  bool Confirm(const Eigen::Vector3d& up);
  void Observe(const TrackedPosture& observed);
  /// From the feet to the centre of mass, mean over the last stances; none for seated people.
  std::optional<Eigen::Vector3d> StandingUp() const;
  void Level(const Eigen::Vector3d& up, double least_deg, const Posture& observed);

  LevelOptions options_;
  std::optional<Eigen::Isometry3d> level_from_camera_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitY();          // up direction of level_from_camera_
  Eigen::Vector3d standing_up_ = Eigen::Vector3d::Zero();  // mean over standing frames
  int standing_frames_ = 0;
  std::deque<Stance> stances_;  // the last fewest_frames with legs and trunk seen
  Eigen::Vector3d floor_up_ = Eigen::Vector3d::UnitY();  // mean of the last floors,
  int floor_frames_ = 0;                                 // ... this many, all similar
  bool floor_confirmed_ = false;                         // whether ever confirmed
};

/// Ours: wraps any method for a camera that may be tilted. A new tilt is a cut for the method: its
/// motion history becomes invalid, bone lengths remain.
std::unique_ptr<Reconstructor> MakeLevelled(std::unique_ptr<Reconstructor> method);

/// The posture with all positions, and orientations if any, transformed.
Posture Moved(const Posture& posture, const Eigen::Isometry3d& to_from);

}  // namespace ossa::recon
