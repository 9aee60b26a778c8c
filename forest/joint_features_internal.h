#pragma once
#include <cstddef>

namespace ossa::forest {

/// How many numbers the refinement reads of an object: part of the model's format, for its first
/// layer has as many inputs. forest/proposals/joint_features.cpp computes them.
inline constexpr size_t kModes = 3;             // told of a target
inline constexpr size_t kNumbersOfMode = 8;     // of each
inline constexpr size_t kNumbersOfTarget = 15;  // without the modes
inline constexpr size_t kNumbersOfClass = 7;
inline constexpr size_t kNumbersOfObject = 10;  // without the contexts

/// Numbers that describe an object of so many targets, classes (background counts) and contexts.
inline constexpr size_t JointFeatureCount(size_t targets, size_t classes, size_t contexts) {
  return contexts + kNumbersOfObject + targets * (kNumbersOfTarget + kModes * kNumbersOfMode) +
         (classes - 1) * kNumbersOfClass;
}

}  // namespace ossa::forest
