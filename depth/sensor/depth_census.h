#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/sensor/body_bulge.h"
#include "depth/sensor/surface_bend.h"

namespace ossa::depth {

/// The likely meaning of depth values that are not millimetres of people.
struct DepthSuspicion {
  std::string looks;   // "centimetres: as millimetres half of them ..."
  std::string option;  // option that reads them correctly; "" if there is none
};

/// Collects statistics of depth images without a stated unit and decides whether they can be
/// millimetres of people. Only properties that no depth camera has are evidence: remainders, bytes,
/// ranges in which no sensor measures and no room ends, surfaces and bodies with the wrong
/// curvature.
class DepthCensus {
 public:
  void Add(const DepthView& image);
  /// Whether there are enough data to judge.
  bool IsEnough() const;
  /// None if they can be millimetres, or without enough data.
  std::optional<DepthSuspicion> Judge() const;
  /// Whether nearly all lies farther away than people before a depth camera stand, as of fifths or
  /// quarters of a millimetre: some cameras measure so far, and the median is returned, metres.
  std::optional<double> FindFarMedian_m() const;

 private:
  std::vector<int64_t> count_ = std::vector<int64_t>(65536, 0);  // histogram of values
  int64_t steps_ = 0;       // horizontal neighbours with different values,
  int64_t steps_of_8_ = 0;  // ... differing by a multiple of 8
  SurfaceBend bend_;
  BodyBulge bulge_, bulge_of_centimetres_{0.1};
};

}  // namespace ossa::depth
