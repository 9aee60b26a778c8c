#pragma once
#include <cstddef>

namespace ossa::forest {

/// Sizes of the refinement's input: part of the model format, as they determine its first layer.
/// Computed by forest/proposals/joint_features.cpp.
inline constexpr size_t kModes = 3;             // modes per target
inline constexpr size_t kNumbersOfMode = 8;     // numbers per mode
inline constexpr size_t kNumbersOfTarget = 15;  // numbers per target, without its modes
inline constexpr size_t kNumbersOfClass = 7;
inline constexpr size_t kNumbersOfObject = 10;  // numbers per object, without contexts

/// Number of features of an object, for these numbers of targets, classes (including background)
/// and contexts.
inline constexpr size_t JointFeatureCount(size_t targets, size_t classes, size_t contexts) {
  return contexts + kNumbersOfObject + targets * (kNumbersOfTarget + kModes * kNumbersOfMode) +
         (classes - 1) * kNumbersOfClass;
}

}  // namespace ossa::forest
