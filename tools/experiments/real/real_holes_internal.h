#pragma once
#include <cstdint>
#include <string_view>

#include "tools/experiments/real/real_sets_internal.h"

namespace ossa::tools {

/// Pixels of a real image that are set to no reading, as other sensors do.
enum class Holes {
  kTenth,  // of all pixels, at random: time of flight before dark cloth
  kThird,  // the same
  kGrid,   // every third row and column: depth registered to a larger image
};
inline constexpr std::array kAllHoles = {Holes::kTenth, Holes::kThird, Holes::kGrid};
std::string_view HolesName(Holes holes);

/// The set with such holes in its images; equal seeds give equal holes.
RealSet WithHoles(RealSet set, Holes holes, uint64_t seed);

}  // namespace ossa::tools
