#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "recon/skeleton_sequence.h"

namespace ossa::tracker {

/// The floor of a recording that has none, from its people: up is from the ankles to the shoulders
/// of who stands straight, the floor below the lower foot, in the middle (median) of all such
/// frames. a b c d of ax + by + cz + d = 0, unit normal up; nothing where people stand straight
/// in fewer than 15 postures. Joints of sensors lie some centimetres off, and so does this floor.
std::optional<Eigen::Vector4d> EstimateFloor(const recon::SkeletonSequence& sequence);

/// Inverse dynamics of what FollowMechanically made (physics::ComputeDynamics): a CSV line a person
/// and frame, its columns named in the first line, newtons, newton metres and metres in the space
/// of the recording. `mass_kg` of every person, 0: from the bones. Throws InputError for a
/// recording without floor and for one whose frames come too far apart.
void WriteDynamics(const std::filesystem::path& path, const recon::SkeletonSequence& sequence,
                   double mass_kg);

}  // namespace ossa::tracker
