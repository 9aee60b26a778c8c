#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <deque>
#include <memory>
#include <optional>

#include "recon/methods/reconstructor.h"

namespace ossa::recon {

// Constants: by hand where nothing else is said.

/// When and by what the camera is taken to be tilted.
struct LevelOptions {
  // A camera that is tilted by less counts as level: no method's error changes by so little, and
  // neither a floor plane nor a standing body is known much better.
  double floor_least_deg = 3.0, body_least_deg = 8.0;
  double change_deg = 4.0;  // another tilt by more is taken over: the camera was moved
  double most_deg = 40.0;   // farther from the camera's up lies nobody's floor, and stands nobody
  int floor_frames = 5;  // with a floor of that tilt one after the other: one alone may be a table
  // Of a body that stands: thighs, shanks and trunk lean from the line of balance by no more, on
  // the mean of half a second, in which noise and the steps of who walks cancel. Who sits leans
  // more.
  double most_bent_deg = 40.0;
  // Both of its feet carry it, and are not so far apart that it could stand over one of them.
  double most_raised_m = 0.12, most_apart_m = 0.45;
  int fewest_frames = 15;  // of a body that stands or walks, half a second
  int memory_frames = 90;  // three seconds; people sway and lean
};

/// Of both sides of somebody, metres.
struct Stance {
  Eigen::Vector3d balance_m;                    // from the middle of the feet to the mass's
  Eigen::Vector3d trunk_m, thighs_m, shanks_m;  // each from its lower end to its upper
};

/// Which way is up in the camera's space: by the floor where one is known, else by the person,
/// whose centre of mass is above the feet, straight or bent, or they would fall. The papers assume
/// a level camera: their placement, database and upright test know turns about the vertical only.
class LevelEstimator {
 public:
  explicit LevelEstimator(const LevelOptions& options = {}) : options_(options) {}
  /// Takes points of camera space to a level space with y up; nothing while the camera counts as
  /// level. The same from frame to frame until the tilt changes; the person stays in place.
  const std::optional<Eigen::Isometry3d>& Update(const TrackedPosture& observed,
                                                 const std::optional<Eigen::Vector4d>& floor);
  void Reset() { *this = LevelEstimator(options_); }

 private:
  /// Whether a floor of that tilt was seen for long enough.
  bool Confirm(const Eigen::Vector3d& up);
  void Observe(const TrackedPosture& observed);
  /// From the feet to the centre of mass, on the mean of the last stances; none of who sits.
  std::optional<Eigen::Vector3d> StandingUp() const;
  void Level(const Eigen::Vector3d& up, double least_deg, const Posture& observed);

  LevelOptions options_;
  std::optional<Eigen::Isometry3d> level_from_camera_;
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitY();          // that level_from_camera_ was made of
  Eigen::Vector3d standing_up_ = Eigen::Vector3d::Zero();  // mean over frames of a standing body
  int standing_frames_ = 0;
  std::deque<Stance> stances_;  // the last fewest_frames in which legs and trunk were seen
  Eigen::Vector3d floor_up_ = Eigen::Vector3d::UnitY();  // of the last floors,
  int floor_frames_ = 0;                                 // ... so many, all alike
  bool floor_confirmed_ = false;                         // ever
};

/// Ours: any method, for a camera that may be tilted. A new tilt is a cut for the method: nothing
/// of how the person moved before holds, but bones do.
std::unique_ptr<Reconstructor> MakeLevelled(std::unique_ptr<Reconstructor> method);

/// Every position, and where there are any every orientation, moved.
Posture Moved(const Posture& posture, const Eigen::Isometry3d& to_from);

}  // namespace ossa::recon
