#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/sensor/body_bulge.h"
#include "depth/sensor/surface_bend.h"

namespace ossa::depth {

/// What depths are, if not millimetres of people.
struct DepthSuspicion {
  std::string looks;   // "centimetres: as millimetres half of them ..."
  std::string option;  // that reads them so; "" where there is none
};

/// Counts the numbers in depth images that state no unit and says whether they can be millimetres
/// of people. Only what no depth camera makes is evidence: remainders, bytes, a range where no
/// sensor sees and no room ends, surfaces and bodies that bend the wrong way.
class DepthCensus {
 public:
  void Add(const DepthView& image);
  /// Whether enough was seen to judge by.
  bool IsEnough() const;
  /// Nothing where they can be, or where too little was seen.
  std::optional<DepthSuspicion> Judge() const;

 private:
  std::vector<int64_t> count_ = std::vector<int64_t>(65536, 0);  // of each number
  int64_t steps_ = 0;       // pairs of neighbours in a row that differ,
  int64_t steps_of_8_ = 0;  // ... by a multiple of 8
  SurfaceBend bend_;
  BodyBulge bulge_, bulge_of_centimetres_{0.1};
};

}  // namespace ossa::depth
