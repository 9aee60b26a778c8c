#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "physics/world.h"
#include "recon/posture.h"

namespace ossa::physics {

// Constants: chosen by hand unless stated otherwise.

struct CharacterFilterOptions {
  int substeps = 10;                  // per 1/30 s, [5, 100]
  Control control = Control::kPaper;  // character.h
  ControlGains gains;                 // character.h
  double lead = 1.0;                  // CharacterOptions::lead; share
  bool floor = true;                  // use the floor when one is given
  bool pin_feet = true;
  bool self_collision = true;
  bool hinges = false;        // elbows and knees are hinges instead of ball joints
  bool joint_limits = false;  // joints keep to human ranges of motion
  double stature_m = 0.0;     // 0: from the bones
  double mass_kg = 0.0;       // 0: from the stature
  /// A target at this mean distance of joints from the character for `teleport_frames` frames in a
  /// row is not noise: the character is put there. Until then bounded forces move it there.
  double teleport_m = 1.0;
  int teleport_frames = 3;
  uint64_t seed = 1;
  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// Result of the filter for one frame.
struct FilteredPosture {
  recon::Posture posture;                // all finite; bone lengths exact
  recon::JointOrientations orientation;  // absolute, recon/orientation.h
  bool left_foot_pinned = false, right_foot_pinned = false;
  bool placed = false;            // the character was put there: first frame, gap or teleport
  double max_anchor_gap_m = 0.0;  // between the two sides of a ball joint, now
  double max_solver_gap_m =
      0.0;                     // the same before the bodies were reconnected, largest of the step
  double floor_depth_m = 0.0;  // how deep the lowest capsule lies in the floor
};

/// The physical character as a filter of postures (Shum et al. 2013, sec. VII). Its postures keep
/// bone lengths, stay above the floor, stand on their feet and obey the dynamics of masses.
/// One object per person; it must not be used by two threads at once.
class CharacterFilter {
 public:
  /// Throws InputError for lengths that are not in (0, 2] m, std::invalid_argument for options.
  explicit CharacterFilter(const recon::BoneLengths& lengths,
                           const CharacterFilterOptions& options = {});
  ~CharacterFilter();
  CharacterFilter(CharacterFilter&&) noexcept;
  CharacterFilter& operator=(CharacterFilter&&) noexcept;

  /// `target`: camera space or any other right-handed frame, `floor` in the same. `weight`: one
  /// entry per joint in [0, 1], empty: all 1. NaN joints are allowed. `dt_s`: seconds since the
  /// last step; after more than 0.25 s the character restarts. `orientation`: see World.
  FilteredPosture Step(const recon::Posture& target, std::span<const double> weight,
                       const std::optional<Eigen::Vector4d>& floor, double dt_s,
                       const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Forgets the character's state; the next Step places it at its target.
  void Reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::physics
