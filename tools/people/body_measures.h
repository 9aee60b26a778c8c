#pragma once
#include <array>
#include <optional>

namespace ossa::people {

/// What tells one body from another whatever it does, as far as it is seen; metres.
enum class Measure { kHeadHeight, kShoulders, kTrunk, kUpperArm, kThigh, kShin, kCount };
inline constexpr size_t kMeasureCount = static_cast<size_t>(Measure::kCount);

/// Measures in one frame; nothing where that part of the body was not seen well.
using FrameMeasures = std::array<std::optional<float>, kMeasureCount>;

/// How measures of two frames, or of a track and a frame, are compared.
struct BodyMatchOptions {
  int max_frames = 60;  // then as an exponential mean: coats come off; by hand: 2 s, > 0
  // Times the spread over frames, measured in the first three of somebody who comes out from behind
  // another.
  double half_hidden = 2.5;
  double max_log_odds = 3.0;  // > 0; so that one wrong measure does not outweigh the others
  // Share of the sum that counts: measures of one body go together, for who is tall has long legs;
  // by hand, (0, 1].
  double independent = 1.0 / 3;
};

/// A body as all frames so far show it: means.
struct BodyMeasures {
  std::array<float, kMeasureCount> mean_m{};
  std::array<int, kMeasureCount> frames{};  // that each mean is of
  void Add(const FrameMeasures& frame, const BodyMatchOptions& options = {});
};

/// Log of how much likelier the measures are when both are of one body than when they are of two
/// people. 0 where nothing can be compared; bounded, for a frame may be wrong altogether. Measures
/// of somebody half hidden are rougher.
double CompareMeasures(const BodyMeasures& known, const FrameMeasures& frame,
                       bool half_hidden = false, const BodyMatchOptions& options = {});

}  // namespace ossa::people
