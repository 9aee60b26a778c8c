#pragma once
#include <span>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// Shum 2013 sec. VII-B: the orientation of each bone as the weighted mean of those of the database
/// postures, turned by the smallest rotation onto the bone's direction in the posture made: axial
/// rotation from the database, direction from the posture. Camera from bone.
JointOrientations TurnedOntoBones(const PostureDatabase& database, std::span<const int> postures,
                                  std::span<const double> weights, const Posture& in_camera,
                                  double yaw_rad);

/// Weights of sec. VII-B: the inverse of eq. 9 between the posture made and each neighbour, all R_i
/// one: of the posture made every joint is known.
std::vector<double> InverseDistances(const PostureDatabase& database,
                                     std::span<const int> neighbours, const PostureVector& made);

}  // namespace ossa::recon
