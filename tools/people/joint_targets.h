#pragma once
#include <array>
#include <string>

#include "forest/forest.h"
#include "recon/skeleton.h"

namespace ossa::people {

/// The index of the forest's target of each joint, in SDK order.
using JointTargets = recon::JointArray<int>;

/// Throws InputError that names the model if it lacks a joint or has classes other than body parts.
JointTargets FindJointTargets(const forest::ForestModel& model, const std::string& model_name);

}  // namespace ossa::people
