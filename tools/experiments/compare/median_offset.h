#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// The offset of clocks on which pieces of recordings agree.
struct MedianOffset {
  double offset_s = 0.0;          // to add to the times of the results
  double standard_error_s = 0.0;  // of the median
  double frame_s = 0.0;           // median step between the results' frames
  size_t pieces = 0;
};

/// Offsets of less than 0.3 s between recordings of one clock, measured on pieces of 3 s. One piece
/// is accurate to about a frame only; many show a part of a frame.
class OffsetOfPieces {
 public:
  /// Measures all pieces of a pair, until there are enough. `stop` as in MatchClocks().
  void Add(const PairedTracks& pair, const std::function<bool()>& stop = {});
  /// The median, if it is evidently not zero: half a frame or more, and four standard errors. None
  /// for fewer than eight pieces.
  std::optional<MedianOffset> FindEvident() const;

 private:
  std::vector<double> offsets_s_, steps_s_;
};

}  // namespace ossa::tools
