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

/// Which bones a person's character has: those of the first posture, and others once the postures
/// have come to have others for a while.
class CharacterBones {
 public:
  /// True when the character is to be made, the first time or anew. Bones that cannot be had are
  /// the standard ones, at the size of the others.
  bool Update(const recon::Posture& seen);
  const recon::BoneLengths& lengths_m() const { return bones_m_; }

 private:
  recon::BoneLengths bones_m_{};   // the character's; 0 before there is one
  recon::BoneLengths latest_m_{};  // of the last posture
  int same_frames_ = 0;            // for how long they have been so
};

/// How far a character is led to a joint that is known and trusted so: what nobody saw was placed
/// by someone who knew better.
double HeldTrust(double trust);

/// The mechanical character of one person: made at the first posture, with its bones, and led by
/// the postures that follow. Made anew when they come to have other bones, and keep those.
class Mechanics {
 public:
  /// `rate_rad_s`: physics::ControlGains::rate_rad_s, how fast postures are followed.
  explicit Mechanics(const MechanicsBuild& build,
                     double rate_rad_s = physics::ControlGains{}.rate_rad_s)
      : build_(build), rate_rad_s_(rate_rad_s) {}
  /// What the character makes of `target`, on which it is put at first, after a gap and when time
  /// runs backwards (recon::FrameSteps); nothing of a character that came to grief. Joints that are
  /// not finite lead it nowhere.
  /// `orientation`: how the bones are turned about themselves, where that is known.
  std::optional<physics::FilteredPosture> Follow(
      const recon::Posture& target, std::span<const double> trust,
      const std::optional<Eigen::Vector4d>& floor, double time_s,
      const std::optional<recon::JointOrientations>& orientation = std::nullopt);

 private:
  /// The floor, if it can be the one that the person stands on.
  std::optional<Eigen::Vector4d> OwnFloor(const recon::Posture& target,
                                          const std::optional<Eigen::Vector4d>& floor);
  void Make();

  MechanicsBuild build_;
  double rate_rad_s_;
  std::unique_ptr<physics::CharacterFilter> character_;
  CharacterBones bones_;
  recon::FrameSteps steps_;
  bool floor_is_another_ = false;  // what was taken for the floor is not under the person
};

}  // namespace ossa::tracker
