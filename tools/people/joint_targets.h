#pragma once
#include <array>
#include <string>

#include "forest/forest.h"
#include "recon/skeleton.h"

namespace ossa::people {

/// Which of a forest's targets is which joint, in SDK order.
using JointTargets = recon::JointArray<int>;

/// Throws InputError that names the model where it lacks a joint, or knows other classes than parts
/// of the body.
JointTargets FindJointTargets(const forest::ForestModel& model, const std::string& model_name);

}  // namespace ossa::people
