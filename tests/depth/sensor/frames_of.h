#pragma once
#include <chrono>
#include <utility>
#include <vector>

#include "depth/sensor/frame_source.h"

namespace ossa::test {

/// The remaining frames of a recording.
inline std::vector<depth::DepthFrame> FramesOf(depth::FrameSource& source) {
  std::vector<depth::DepthFrame> frames;
  for (;;) {
    depth::ReadResult read = source.Read(std::chrono::seconds(1));
    if (read.status == depth::ReadStatus::kEnd) return frames;
    if (read.status == depth::ReadStatus::kFrame) frames.push_back(std::move(read.frame));
  }
}

}  // namespace ossa::test
