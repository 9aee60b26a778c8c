#pragma once
#include <array>
#include <cstddef>

#include "recon/skeleton.h"

namespace ossa::recon {

/// One value of type T per joint, in the order of Joint; indexed by Joint or by number.
template <typename T>
struct JointArray : std::array<T, kJointCount> {
  using std::array<T, kJointCount>::operator[];
  constexpr T& operator[](Joint joint) { return (*this)[static_cast<size_t>(joint)]; }
  constexpr const T& operator[](Joint joint) const { return (*this)[static_cast<size_t>(joint)]; }
};

}  // namespace ossa::recon
