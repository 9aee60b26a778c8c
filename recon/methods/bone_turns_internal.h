#pragma once
#include <span>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// Shum 2013 sec. VII-B: the orientation of each bone as the weighted mean of those of the database
/// postures, turned by the smallest rotation onto the bone's direction in the posture made: axial
/// rotation from the database, direction from the posture. Camera from bone, in the convention of
/// recon/orientation.h.
JointOrientations TurnedOntoBones(const PostureDatabase& database, std::span<const int> postures,
                                  std::span<const double> weights, const Posture& in_camera,
                                  double yaw_rad);

/// Weights of sec. VII-B: the inverse of eq. 9 between each neighbour and the posture made.
/// Departure: 1 cm^2 is added, or a neighbour hit exactly would silence the others.
std::vector<double> InverseDistances(const PostureDatabase& database,
                                     std::span<const int> neighbours, const PostureVector& made,
                                     const JointWeights& reliability);

}  // namespace ossa::recon
