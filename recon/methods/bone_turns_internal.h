#pragma once
#include <span>

#include "recon/database/posture_database.h"

namespace ossa::recon {

/// Shum 2013 sec. VII-B: the orientation of each bone as the weighted mean over database postures,
/// rotated by the smallest rotation onto the bone's direction in the result: axial rotation from
/// the database, direction from the result. Camera from bone, in the convention of
/// recon/orientation.h.
JointOrientations TurnedOntoBones(const PostureDatabase& database, std::span<const int> postures,
                                  std::span<const double> weights, const Posture& in_camera,
                                  double yaw_rad);

/// Weights of sec. VII-B: the inverse of eq. 9 between each neighbour and the result. Departure: 1
/// cm^2 is added, so that an exact match does not get all the weight.
std::vector<double> InverseDistances(const PostureDatabase& database,
                                     std::span<const int> neighbours, const PostureVector& made,
                                     const JointWeights& reliability);

}  // namespace ossa::recon
