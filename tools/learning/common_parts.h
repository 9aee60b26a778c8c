#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "forest/forest.h"
#include "recon/skeleton.h"

namespace ossa::tools {

// Constants: counted in the table of common_parts.cpp; none by convention.

/// Parts common to our 31 and the 25 of PCL's people trees, on which the two are compared.
inline constexpr int kCommonPartCount = 20;
inline constexpr uint8_t kNoCommonPart = 255;

std::array<std::string_view, kCommonPartCount> CommonPartNames();

/// The common part that a true label (recon::kPartNames) stands for; kNoCommonPart where PCL has no
/// such class: shoulders, wrists and ankles, whose borders PCL draws elsewhere, and objects. Pixels
/// of those are not counted.
uint8_t ToCommonPart(uint8_t label);

/// The common part of each class of a model, given by the classes' names: ours or PCL's. Nothing
/// when they are neither's.
std::optional<std::vector<uint8_t>> FindCommonParts(std::span<const std::string> class_names);

/// Joints that lie within one class of either: only these can be compared.
bool IsCommonJoint(recon::Joint joint);

/// The 20 joints as targets of a model of PCL's classes; those that no class stands for have none.
std::vector<forest::ProposalTarget> PclTargets(std::span<const std::string> class_names);

}  // namespace ossa::tools
