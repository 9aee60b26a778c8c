#pragma once
#include <array>
#include <optional>

namespace ossa::people {

/// What tells one body from another whatever it does, as far as it is seen; metres.
enum class Measure { kHeadHeight, kShoulders, kTrunk, kUpperArm, kThigh, kShin, kCount };
inline constexpr size_t kMeasureCount = static_cast<size_t>(Measure::kCount);

/// Measures in one frame; nothing where that part of the body was not seen well.
using FrameMeasures = std::array<std::optional<float>, kMeasureCount>;

/// A body as all frames so far show it: means.
struct BodyMeasures {
  std::array<float, kMeasureCount> mean_m{};
  std::array<int, kMeasureCount> frames{};  // that each mean is of
  void Add(const FrameMeasures& frame);
};

/// Log of how much likelier the measures are when both are of one body than when they are of two
/// people. 0 where nothing can be compared; bounded, for a frame may be wrong altogether. Measures
/// of somebody half hidden are rougher.
double CompareMeasures(const BodyMeasures& known, const FrameMeasures& frame,
                       bool half_hidden = false);

}  // namespace ossa::people
