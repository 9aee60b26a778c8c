#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace ossa::tools {

/// Calibration of confidences: of the joints with a confidence of 0.7 to 0.8, 70 to 80 % should be
/// within the tolerance. Joints are counted in tenths of confidence.
class Calibration {
 public:
  struct Bin {
    int64_t joints = 0;
    int64_t hits = 0;
    double mean_confidence = 0.0;
  };
  static constexpr size_t kBins = 10;  // by convention, tenths

  /// `confidence` is clamped to [0, 1].
  void Count(double confidence, bool is_hit);

  /// From low confidences to high ones.
  std::array<Bin, kBins> Bins() const;

  /// Expected calibration error: how far the share of hits lies from the mean confidence, over the
  /// bins, weighted by their joints. NaN when nothing was counted.
  double ExpectedError() const;

 private:
  std::array<int64_t, kBins> joints_{};
  std::array<int64_t, kBins> hits_{};
  std::array<double, kBins> confidence_sum_{};
};

}  // namespace ossa::tools
