#pragma once
#include <numbers>

namespace ossa {

/// Radians, by definition: `20 * kDegree`.
inline constexpr double kDegree = std::numbers::pi / 180.0;

inline constexpr double ToDegrees(double radians) { return radians * (180.0 / std::numbers::pi); }

}  // namespace ossa
