#pragma once
// Protocol from a reader program (standard output) to ReaderSource: native structs, because both
// ends are of one build on one machine. Readers are separate programs so that a file that makes a
// library crash, hang or exhaust memory affects only them, and so that users who never read such
// files do not need the library.
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "depth/image/camera.h"

namespace ossa::depth {

enum class ReaderKind : uint32_t { kHello = 1, kFrame, kEnd, kError, kNote, kWarning };

/// Header of every message, followed by its contents: a ReaderHello; a ReaderFrame and its width ×
/// height uint16; nothing; or text.
struct ReaderMessage {
  static constexpr uint32_t kMagic = 0x6f737361;
  uint32_t magic = kMagic;
  ReaderKind kind = ReaderKind::kEnd;
  uint64_t size = 0;  // size of the contents, bytes
};

struct ReaderHello {
  Camera camera;  // camera of the frames; its size is valid even if no camera is stated
  bool is_camera_stated = false;
  bool is_unit_stated = false;      // the values are millimetres; else unknown
  std::array<uint8_t, 6> unused{};  // no uninitialised byte is sent
  int64_t frame_count = -1;         // -1: unknown
};

static_assert(sizeof(ReaderHello) == sizeof(Camera) + 16);

struct ReaderFrame {
  int32_t width = 0, height = 0;
  double time_s = 0.0;
  int64_t dropped = 0;  // frames dropped since the previous one
};

/// Reader side. Messages are written completely; a reader whose parent is gone exits.
void Send(ReaderKind kind, std::span<const std::byte> contents = {});
void SendText(ReaderKind kind, const std::string& text);
void SendHello(const ReaderHello& hello);
/// depth: row-major, height × width.
void SendFrame(const ReaderFrame& frame, std::span<const uint16_t> depth);

/// Main function of a reader: runs `read` with limited memory, reports its InputErrors or
/// successful end, and exits without cleaning up a possibly corrupted library.
[[noreturn]] void RunReader(const std::function<void()>& read);

}  // namespace ossa::depth
