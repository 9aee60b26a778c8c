#pragma once
#include <cstdint>
#include <fstream>
#include <vector>

#include "depth/sensor/oni_format_internal.h"

namespace ossa::depth {

/// How the records behind the head of a recording of ours come to their end.
enum class OniEnd {
  kWhole,    // with the record that ends a recording, and the file ends there, too
  kCut,      // the file ends within a record or before the last
  kDamaged,  // something stands where no recorder put it
};

struct OniFrames {
  std::vector<OniFrameAt> frames;  // those that are whole, in order
  OniEnd end = OniEnd::kDamaged;
};

/// Goes from record to record, from byte `begin` on, as OniRecorder writes them. Reads their heads
/// only: an hour takes a moment.
OniFrames FindOniFrames(std::ifstream& file, uint64_t begin);

}  // namespace ossa::depth
