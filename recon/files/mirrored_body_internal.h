#pragma once
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// A warning if feet point and knees bend to the back of the body: left and right are then
/// exchanged, in a file of mirrored images or of left-handed axes. "" if they do not, or if the
/// recording shows too little of them. Otherwise every method would see another person, silently.
std::string DescribeMirrored(const SkeletonSequence& sequence);

}  // namespace ossa::recon
