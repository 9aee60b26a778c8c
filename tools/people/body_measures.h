#pragma once
#include <array>
#include <optional>

namespace ossa::people {

/// Lengths that differ between bodies and do not depend on the pose; metres.
enum class Measure { kHeadHeight, kShoulders, kTrunk, kUpperArm, kThigh, kShin, kCount };
inline constexpr size_t kMeasureCount = static_cast<size_t>(Measure::kCount);

/// Measures in one frame; empty where that part of the body was not seen well.
using FrameMeasures = std::array<std::optional<float>, kMeasureCount>;

/// How measures of two frames, or of a track and a frame, are compared.
struct BodyMatchOptions {
  int max_frames = 60;  // then an exponential mean: coats come off; by hand: 2 s, > 0
  // Factor of the spread over frames for occluded people, measured in the first three frames of
  // people who come out from behind another.
  double half_hidden = 2.5;
  double max_log_odds = 3.0;  // > 0; so that one wrong measure does not outweigh the others
  // Factor of the sum, (0, 1], because measures of one body correlate: tall people have long legs;
  // by hand.
  double independent = 1.0 / 3;
};

/// Mean measures of a track.
struct BodyMeasures {
  std::array<float, kMeasureCount> mean_m{};
  std::array<int, kMeasureCount> frames{};  // number of frames in each mean
  void Add(const FrameMeasures& frame, const BodyMatchOptions& options = {});
};

/// Log-likelihood ratio of the measures being of one body against two. 0 where no measure is in
/// both; bounded, because all measures of a frame may be wrong. `half_hidden`: the person is partly
/// occluded and the measures are noisier.
double CompareMeasures(const BodyMeasures& known, const FrameMeasures& frame,
                       bool half_hidden = false, const BodyMatchOptions& options = {});

}  // namespace ossa::people
