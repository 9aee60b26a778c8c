#pragma once
// What a reader program writes to its standard output and ReaderSource reads: native structs, both
// ends being of one build on one machine. A reader is a program of its own so that a file that
// crashes, hangs or bloats somebody's library ends it and not the one that wants the frames; and so
// that who never reads such files need not have the library.
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "depth/image/camera.h"

namespace ossa::depth {

enum class ReaderKind : uint32_t { kHello = 1, kFrame, kEnd, kError, kNote, kWarning };

/// Before every message, whose contents follow: a ReaderHello; a ReaderFrame and its width × height
/// uint16; nothing; or text.
struct ReaderMessage {
  static constexpr uint32_t kMagic = 0x6f737361;
  uint32_t magic = kMagic;
  ReaderKind kind = ReaderKind::kEnd;
  uint64_t size = 0;  // of the contents, bytes
};

struct ReaderHello {
  Camera camera;  // of the frames; its size is theirs even where nothing states a camera
  bool is_camera_stated = false;
  bool is_unit_stated = false;      // the numbers are millimetres; else nobody knows
  std::array<uint8_t, 6> unused{};  // no byte is sent that was not written
  int64_t frame_count = -1;         // -1: the file does not know
};

static_assert(sizeof(ReaderHello) == sizeof(Camera) + 16);

struct ReaderFrame {
  int32_t width = 0, height = 0;
  double time_s = 0.0;
  int64_t dropped = 0;  // frames left out since the one before
};

/// The reader's end. Each message is written whole; a reader whose parent is gone ends.
void Send(ReaderKind kind, std::span<const std::byte> contents = {});
void SendText(ReaderKind kind, const std::string& text);
void SendHello(const ReaderHello& hello);
/// depth: row-major, height × width.
void SendFrame(const ReaderFrame& frame, std::span<const uint16_t> depth);

/// A reader's main: runs `read` with bounded memory, tells its InputErrors, or that it ended well,
/// and leaves without tidying up a library that may be damaged.
[[noreturn]] void RunReader(const std::function<void()>& read);

}  // namespace ossa::depth
