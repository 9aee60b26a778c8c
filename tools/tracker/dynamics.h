#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "recon/skeleton_sequence.h"

namespace ossa::tracker {

/// Estimates the floor of a recording without one from people who stand straight: up is from ankles
/// to shoulders, the height is the median of the lower foot over these frames. a b c d of ax + by +
/// cz + d = 0, unit normal up; empty for fewer than 15 such postures. As accurate as the sensor's
/// joints: some centimetres.
std::optional<Eigen::Vector4d> EstimateFloor(const recon::SkeletonSequence& sequence);

/// Writes the inverse dynamics (physics::ComputeDynamics) of a sequence made by FollowMechanically:
/// a CSV line per person and frame, columns named in the first line; newtons, newton metres and
/// metres, in the space of the recording. `mass_kg` of every person, 0: from the bones. Throws
/// InputError for a recording without a floor and for one with too large gaps between frames.
void WriteDynamics(const std::filesystem::path& path, const recon::SkeletonSequence& sequence,
                   double mass_kg);

}  // namespace ossa::tracker
