#pragma once
#include <functional>
#include <string>
#include <vector>

#include "recon/motion/bvh.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// A BVH as a motion for retargeting. Throws InputError if it has no channels, as one of several
/// roots may: then there are no frames.
SourceMotion ToSourceMotion(BvhFile file, const std::string& source);

/// Calls `take` with the skeleton of each root; it throws InputError for a root that is not a
/// person. A prop beside people is skipped with a line in `warnings`; if no root is a person the
/// first error is thrown.
void ForEachPerson(BvhFile bvh, const std::string& source, std::vector<std::string>& warnings,
                   const std::function<void(BvhFile)>& take);

}  // namespace ossa::recon
