#pragma once
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

// Checks of a sequence that was read; `name` is the file's, for the InputError they throw.

/// Positions farther away than any sensor sees: their squares would overflow and give an infinite
/// mean error. The file is damaged or in an unusual unit.
void CheckPositions(const SkeletonSequence& sequence, const std::string& name);

/// Two bodies of one id in a frame.
void CheckBodies(const SkeletonSequence& sequence, const std::string& name);

/// Times that go back, or that repeat always, or in every second frame or more: speeds, filters and
/// time alignment would be meaningless. Row formats have already reported the line.
void CheckTimes(const SkeletonSequence& sequence, const std::string& name);

}  // namespace ossa::recon
