#pragma once
#include <numbers>

namespace ossa {

inline constexpr double ToRadians(double degrees) { return degrees * (std::numbers::pi / 180.0); }
inline constexpr double ToDegrees(double radians) { return radians * (180.0 / std::numbers::pi); }

}  // namespace ossa
