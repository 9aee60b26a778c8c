#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {
class PostureDatabase;  // recon/database/posture_database.h
}

namespace ossa::tools {

/// Lower bound of the error of a database with the person's true bone lengths: eq. 18 of Shum 2013,
/// centimetres, mean over the frames.
struct DatabaseBound {
  double nearest_cm = 0.0;   // of the posture with the least eq. 18, all joints known
  double by_parts_cm = 0.0;  // of the posture nearest in the given parts
};

/// `parts`: the known joints, besides the root. Empty if no frame has all joints.
std::optional<DatabaseBound> ComputeBound(const recon::PostureDatabase& database,
                                          const recon::SkeletonSequence& truth,
                                          const std::vector<recon::Joint>& parts);

/// Eq. 18 between two sequences, mean over the frames, for the bones of trunk and head, of arms and
/// of legs, centimetres.
Eigen::Vector3d ErrorByLimbs_cm(const recon::SkeletonSequence& truth,
                                const recon::SkeletonSequence& made);

}  // namespace ossa::tools
