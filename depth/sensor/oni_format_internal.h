#pragma once
// The .oni container as OpenNI2 2.2 writes and reads it: a 24-byte header, then records.
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depth/image/camera.h"

namespace ossa::depth {

enum class OniRecord : uint32_t {
  kIntProperty = 0x03,
  kGeneralProperty = 0x06,
  kNodeRemoved = 0x07,
  kNodeDataBegin = 0x08,
  kNodeStateReady = 0x09,
  kNewData = 0x0A,
  kEnd = 0x0B,
  kNodeAdded = 0x0D,
  kSeekTable = 0x0E,
};

#pragma pack(push, 1)
struct OniFileHeader {
  std::array<char, 4> magic = {'N', 'I', '1', '0'};
  uint8_t major = 1;
  uint8_t minor = 0;
  uint16_t maintenance = 1;
  uint32_t build = 0;
  uint64_t max_timestamp_us = ~uint64_t{0};
  uint32_t max_node_id = 1;
};
struct OniRecordHeader {
  uint32_t magic = kMagic;
  uint32_t type = 0;
  uint32_t node_id = 1;
  uint32_t fields_size = 0;  // bytes, this header included
  uint32_t payload_size = 0;
  uint64_t undo_position = 0;                     // of the record of the same kind before this one
  static constexpr uint32_t kMagic = 0x0052494E;  // "NIR"
};
struct OniSeekEntry {
  uint64_t timestamp_us = 0;
  uint32_t configuration = 0;
  uint64_t position = 0;
};
#pragma pack(pop)
static_assert(sizeof(OniFileHeader) == 24 && sizeof(OniRecordHeader) == 28);

/// The player's buffers: larger frames and seek tables are refused or left out.
inline constexpr int64_t kLargestOniData = 1600 * 1200 * 3;

/// Properties of ours: Camera as six doubles (width height fx fy cx cy), and the XXH3 of the file's
/// bytes from the first frame to the end, then those before it with the seal's value zeroed.
inline constexpr const char* kOniCameraProperty = "ossaCamera";
inline constexpr const char* kOniSealProperty = "ossaSeal";

/// What ossa wrote about a recording before its first frame; empty in other programs' files.
struct OniPreamble {
  std::optional<Camera> camera;
  std::optional<uint64_t> seal;
  size_t seal_at = 0;  // byte of its value
  size_t size = 0;     // bytes before the first frame
};

/// Reads as far as the records before the first frame are well-formed: what is not ours is for
/// OpenNI2 to judge. Never reads past `bytes`.
OniPreamble ParseOniPreamble(std::span<const uint8_t> bytes);

/// What the seal is to be: the XXH3 of the file's bytes from where `unsealed` ends, then of
/// `unsealed`, the bytes before the first frame with the seal's value zeroed.
uint64_t ComputeOniSeal(std::ifstream& file, std::span<const uint8_t> unsealed);

/// Where a frame's compressed depth lies in the file.
struct OniFrameAt {
  uint64_t timestamp_us = 0;
  uint64_t data_at = 0;
  uint32_t data_size = 0;
};

/// A recording before it is played.
struct OniFile {
  std::optional<Camera> camera;  // as ossa wrote it; none in other programs' files
  /// Of a recording of ours that has no seal because its recorder was killed, or that was cut
  /// short: the frames that are whole. What else is in them nothing can vouch for.
  std::optional<std::vector<OniFrameAt>> unfinished;
};

/// Throws InputError unless the file begins as an .oni does, and if it carries any property of ours
/// and is not merely unfinished, has its seal unbroken: it is damaged then.
OniFile CheckOniFile(const std::filesystem::path& path);

}  // namespace ossa::depth
