#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "physics/world.h"
#include "recon/posture.h"

namespace ossa::physics {

// Constants: chosen by hand, where nothing else is said.

struct CharacterFilterOptions {
  int substeps = 10;                  // per 1/30 s, [5, 100]
  Control control = Control::kPaper;  // character.h
  ControlGains gains;                 // character.h
  double lead = 1.0;                  // CharacterOptions::lead; share
  bool floor = true;                  // use the floor when one is given
  bool pin_feet = true;
  bool self_collision = true;
  bool hinges = false;        // elbows and knees are hinges instead of ball joints
  bool joint_limits = false;  // joints keep to the ranges that people's have
  double stature_m = 0.0;     // 0: from the bones
  double mass_kg = 0.0;       // 0: from the stature
  /// A target this far from the character, joints' mean, for `teleport_frames` frames in a row is a
  /// new place, not noise: the character is put there. Until then it moves there by bounded forces.
  double teleport_m = 1.0;
  int teleport_frames = 3;
  uint64_t seed = 1;
  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// What the filter makes of one frame.
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

/// The physical character as a filter (Shum et al. 2013, sec. VII): postures in, postures out that
/// keep bone lengths, stay above the floor, stand on their feet and move as masses move.
/// One object per person. Two filters may run in two threads; one filter may not.
class CharacterFilter {
 public:
  /// Throws InputError for lengths that are not in (0, 2] m, std::invalid_argument for options.
  explicit CharacterFilter(const recon::BoneLengths& lengths,
                           const CharacterFilterOptions& options = {});
  ~CharacterFilter();
  CharacterFilter(CharacterFilter&&) noexcept;
  CharacterFilter& operator=(CharacterFilter&&) noexcept;

  /// `target`: camera space or any other right-handed frame, the floor in the same. `weight`: trust
  /// per joint in [0, 1], empty = all 1. NaN joints are allowed. `dt_s` since the last step; after
  /// a gap of more than 0.25 s the character starts anew. `orientation`: World::SetTarget.
  FilteredPosture Step(const recon::Posture& target, std::span<const double> weight,
                       const std::optional<Eigen::Vector4d>& floor, double dt_s,
                       const std::optional<recon::JointOrientations>& orientation = std::nullopt);
  /// Forgets where the character is; the next Step places it.
  void Reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::physics
