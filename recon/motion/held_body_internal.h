#pragma once
#include "recon/bone_lengths.h"
#include "recon/motion/sightings_internal.h"
#include "recon/posture.h"

namespace ossa::recon {

/// A body over its sightings: bones have constant lengths, the median of each over the recording,
/// and keep their last direction while unseen.
class HeldBody {
 public:
  /// Before its first sighting a bone has the direction of that sighting.
  explicit HeldBody(const SightingLog& seen);

  void Update(const Sighting& sighting);

  const BoneLengths& lengths_m() const { return lengths_m_; }
  const JointArray<Eigen::Vector3d>& direction() const { return direction_; }
  /// Position of HipCenter for which the body is nearest to the joints seen (least squares).
  const Eigen::Vector3d& root_m() const { return root_m_; }
  /// Seen joints at their positions; others at the end of their bone, from their parent.
  Posture WholePosture(const Sighting& sighting) const;

 private:
  BoneLengths lengths_m_;
  JointArray<Eigen::Vector3d> direction_;
  Eigen::Vector3d root_m_ = Eigen::Vector3d::Zero();
};

}  // namespace ossa::recon
