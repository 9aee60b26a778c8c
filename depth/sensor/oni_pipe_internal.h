#pragma once
// Protocol from ossa_oni_reader (standard output) to OniFileSource: native structs, because both
// ends are of one build on one machine.
#include <cstdint>

#include "depth/sensor/image_window_internal.h"

namespace ossa::depth {

struct OniPipeHello {
  static constexpr uint32_t kMagic = 0x6f6e6970;
  uint32_t magic = kMagic;
  ImageWindow window;               // of the following frames
  float horizontal_fov_rad = 0.0f;  // of the full image
  float vertical_fov_rad = 0.0f;
  int32_t frame_count = -1;  // -1: unknown
};

enum class OniPipeKind : uint32_t { kFrame = 1, kEnd = 2, kError = 3 };

/// Header of every message. A frame is followed by its window's width × height uint16 millimetres,
/// not mirrored; an error by `size` characters.
struct OniPipeMessage {
  OniPipeKind kind = OniPipeKind::kEnd;
  uint32_t size = 0;   // size of an error's text
  ImageWindow window;  // window of the frame
  int64_t index = 0;   // from 0
  uint64_t timestamp_us = 0;
};

}  // namespace ossa::depth
