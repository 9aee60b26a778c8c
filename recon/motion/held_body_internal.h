#pragma once
#include "recon/bone_lengths.h"
#include "recon/motion/sightings_internal.h"
#include "recon/posture.h"

namespace ossa::recon {

/// A body through its sightings: bones of constant lengths, the median of each over the recording,
/// which keep their last direction while they are not seen.
class HeldBody {
 public:
  /// Until the first is known, bones point as they are first seen.
  explicit HeldBody(const SightingLog& seen);

  void Update(const Sighting& sighting);

  const BoneLengths& lengths_m() const { return lengths_m_; }
  const JointArray<Eigen::Vector3d>& direction() const { return direction_; }
  /// Of HipCenter: the whole lies nearest to the joints seen (least squares).
  const Eigen::Vector3d& root_m() const { return root_m_; }
  /// Joints where they are seen; the others at the end of their bone from where their parent is.
  Posture WholePosture(const Sighting& sighting) const;

 private:
  BoneLengths lengths_m_;
  JointArray<Eigen::Vector3d> direction_;
  Eigen::Vector3d root_m_ = Eigen::Vector3d::Zero();
};

}  // namespace ossa::recon
