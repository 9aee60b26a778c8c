#pragma once
#include <cstdint>
#include <fstream>
#include <vector>

#include "depth/sensor/oni_format_internal.h"

namespace ossa::depth {

/// How the records of one of our recordings end.
enum class OniEnd {
  kWhole,    // with the end record, at the end of the file
  kCut,      // the file ends within a record or before the end record
  kDamaged,  // an invalid record
};

struct OniFrames {
  std::vector<OniFrameAt> frames;  // complete frames, in order
  OniEnd end = OniEnd::kDamaged;
};

/// Walks the records that OniRecorder wrote, starting at byte `begin`. Reads only their headers: an
/// hour takes a moment.
OniFrames FindOniFrames(std::ifstream& file, uint64_t begin);

}  // namespace ossa::depth
