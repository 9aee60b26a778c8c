#pragma once
#include <cstdint>
#include <string_view>

#include "tools/experiments/real/real_sets_internal.h"

namespace ossa::tools {

/// Which pixels of a real image are left without a reading, as other sensors leave them.
enum class Holes {
  kTenth,  // of all pixels, at random: time of flight before dark cloth
  kThird,  // the same
  kGrid,   // every third row and column: depth registered to a larger image
};
inline constexpr std::array kAllHoles = {Holes::kTenth, Holes::kThird, Holes::kGrid};
std::string_view HolesName(Holes holes);

/// The set with such holes in its images; the same ones for the same seed.
RealSet WithHoles(RealSet set, Holes holes, uint64_t seed);

}  // namespace ossa::tools
