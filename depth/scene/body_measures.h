#pragma once
#include <array>
#include <optional>

namespace ossa::depth {

/// What tells one body from another whatever it does, as far as it is seen; metres.
enum class Measure { kHeadHeight, kShoulders, kTrunk, kUpperArm, kThigh, kShin, kCount };
inline constexpr size_t kMeasureCount = static_cast<size_t>(Measure::kCount);

/// One look's measures; nothing where that part of the body was not seen well.
using MeasuredBody = std::array<std::optional<float>, kMeasureCount>;

/// A body as all looks so far show it: means.
struct BodyMeasures {
  std::array<float, kMeasureCount> mean_m{};
  std::array<int, kMeasureCount> looks{};
  void Add(const MeasuredBody& look);
};

/// Log of how much likelier two looks' measures are when both are of one body than when they are of
/// two people. 0 where nothing can be compared; bounded, for a look may be wrong altogether. A look
/// at somebody half hidden is rougher.
double LogLikelihoodRatio(const BodyMeasures& known, const MeasuredBody& look,
                          bool half_hidden = false);

}  // namespace ossa::depth
