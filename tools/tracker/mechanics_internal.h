#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>

#include "physics/character_filter.h"
#include "recon/filters/frame_steps.h"
#include "recon/posture.h"
#include "tools/tracker/mechanics.h"

namespace ossa::tracker {

/// The bone lengths of a character: of the first posture, and new ones once the postures have had
/// others for several frames.
class CharacterBones {
 public:
  /// True if the character must be built or rebuilt. Missing bones get standard lengths at the
  /// scale of the others.
  bool Update(const recon::Posture& seen);
  const recon::BoneLengths& lengths_m() const { return bones_m_; }

 private:
  recon::BoneLengths bones_m_{};   // of the character; 0 before there is one
  recon::BoneLengths latest_m_{};  // of the last posture
  int same_frames_ = 0;            // frames for which latest_m_ stayed the same
};

/// Rate at which characters follow the tracker's final targets, which are smooth. By a sweep over
/// four rendered clips: at 35, 50, 60, 70 the joint error is 6.27, 6.03, 5.95, 5.91 cm and the
/// acceleration error 1.48, 1.67, 1.80, 1.91 cm/frame^2; without a character 5.87 and 3.33.
inline constexpr double kFollowing_rad_s = 60.0;  // measured

/// Replaces all joints of a body by those of its character; joints that were absent become
/// inferred.
void SetJoints(const recon::Posture& posture, const recon::JointOrientations& orientation,
               recon::BodyRecord& body);

/// The weight with which a character follows a known joint: not below the trust in a reconstructed
/// joint.
double HeldTrust(double trust);

/// The mechanical character of one person: built at the first posture with its bone lengths,
/// following the later ones. Rebuilt when the bone lengths change and stay changed.
class Mechanics {
 public:
  /// how fast postures are followed
  explicit Mechanics(const MechanicsBuild& build,
                     double rate_rad_s = physics::ControlGains{}.rate_rad_s)
      : build_(build), rate_rad_s_(rate_rad_s) {}
  /// The character's posture when following `target`. It is placed on `target` at first, after a
  /// gap and when time runs backwards (recon::FrameSteps). Nothing if the simulation diverged.
  /// Joints that are not finite are ignored. `orientation`: of the bones, where known.
  std::optional<physics::FilteredPosture> Follow(
      const recon::Posture& target, std::span<const double> trust,
      const std::optional<Eigen::Vector4d>& floor, double time_s,
      const std::optional<recon::JointOrientations>& orientation = std::nullopt);

 private:
  /// The floor, if it is plausible as the one the person stands on.
  std::optional<Eigen::Vector4d> OwnFloor(const recon::Posture& target,
                                          const std::optional<Eigen::Vector4d>& floor);
  void Make();

  MechanicsBuild build_;
  double rate_rad_s_;
  std::unique_ptr<physics::CharacterFilter> character_;
  CharacterBones bones_;
  recon::FrameSteps steps_;
  bool floor_is_another_ = false;  // the detected floor is not under the person
};

}  // namespace ossa::tracker
