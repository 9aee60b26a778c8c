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
  uint32_t fields_size = 0;  // bytes, including this header
  uint32_t payload_size = 0;
  uint64_t undo_position = 0;  // position of the previous record of the same kind
  static constexpr uint32_t kMagic = 0x0052494E;  // "NIR"
};
struct OniSeekEntry {
  uint64_t timestamp_us = 0;
  uint32_t configuration = 0;
  uint64_t position = 0;
};
#pragma pack(pop)
static_assert(sizeof(OniFileHeader) == 24 && sizeof(OniRecordHeader) == 28);

/// Size of the player's buffers: larger frames are refused and larger seek tables omitted.
inline constexpr int64_t kLargestOniData = 1600 * 1200 * 3;

/// Our properties: the camera as six doubles (width height fx fy cx cy), and the seal: the XXH3 of
/// the file's bytes from the first frame to the end, then of those before it with the seal's value
/// zeroed.
inline constexpr const char* kOniCameraProperty = "ossaCamera";
inline constexpr const char* kOniSealProperty = "ossaSeal";

/// Our properties before the first frame; empty in other programs' files.
struct OniPreamble {
  std::optional<Camera> camera;
  std::optional<uint64_t> seal;
  size_t seal_at = 0;  // byte offset of its value
  size_t size = 0;     // bytes before the first frame
};

/// Parses as far as the records before the first frame are well-formed; OpenNI2 judges foreign
/// ones. Never reads past `bytes`.
OniPreamble ParseOniPreamble(std::span<const uint8_t> bytes);

/// The expected seal: the XXH3 of the file's bytes after `unsealed`, then of `unsealed`, the bytes
/// before the first frame with the seal's value zeroed.
uint64_t ComputeOniSeal(std::ifstream& file, std::span<const uint8_t> unsealed);

/// Location of a frame's compressed depth in the file.
struct OniFrameAt {
  uint64_t timestamp_us = 0;
  uint64_t data_at = 0;
  uint32_t data_size = 0;
};

/// The result of checking a recording.
struct OniFile {
  std::optional<Camera> camera;  // as written by ossa; none in other programs' files
  /// For our recordings without a seal, because the recorder was killed, or that are truncated: the
  /// complete frames. Their content is not verified.
  std::optional<std::vector<OniFrameAt>> unfinished;
};

/// Throws InputError unless the file starts like an .oni, and, if it has any of our properties and
/// is not merely unfinished, its seal is valid: otherwise it is damaged.
OniFile CheckOniFile(const std::filesystem::path& path);

}  // namespace ossa::depth
