#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {
class PostureDatabase;  // recon/database/posture_database.h
}

namespace ossa::tools {

/// Lower bound of the error with a database, on the performer's own true bones: eq. 18 of Shum
/// 2013 in centimetres, mean over the frames.
struct DatabaseBound {
  double nearest_cm = 0.0;   // of the posture that is best under eq. 18, of which nothing is hidden
  double by_parts_cm = 0.0;  // of the posture that is nearest by the places of the parts given
};

/// `parts` counts the joints that are given; the root is always. Nothing without a whole posture.
std::optional<DatabaseBound> ComputeBound(const recon::PostureDatabase& database,
                                          const recon::SkeletonSequence& truth,
                                          const std::vector<recon::Joint>& parts);

/// Eq. 18 between two performances, mean over the frames, of the bones of trunk and head, of arms
/// and of legs, centimetres.
Eigen::Vector3d ErrorByLimbs_cm(const recon::SkeletonSequence& truth,
                                const recon::SkeletonSequence& made);

}  // namespace ossa::tools
