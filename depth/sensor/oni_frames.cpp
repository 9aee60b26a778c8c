#include "depth/sensor/oni_frames_internal.h"

#include <optional>

namespace ossa::depth {
namespace {

// Fields of a frame record: time and number, from 1.
#pragma pack(push, 1)
struct FrameFields {
  uint64_t timestamp_us = 0;
  uint32_t number = 0;
};
#pragma pack(pop)

template <typename T>
std::optional<T> ReadAt(std::ifstream& file, uint64_t at) {
  T value{};
  file.clear();
  file.seekg(static_cast<std::streamoff>(at));
  if (!file.read(reinterpret_cast<char*>(&value), sizeof(value))) return std::nullopt;
  return value;
}

uint64_t MeasureSize(std::ifstream& file) {
  file.clear();
  file.seekg(0, std::ios::end);
  return static_cast<uint64_t>(file.tellg());
}

bool EndsARecording(const OniRecordHeader& header) {
  return header.magic == OniRecordHeader::kMagic &&
         header.type == static_cast<uint32_t>(OniRecord::kEnd);
}

// Whether OniRecorder writes such records after the head.
bool IsKnown(const OniRecordHeader& header) {
  if (header.magic != OniRecordHeader::kMagic || header.payload_size > kLargestOniData)
    return false;
  const size_t fields = header.fields_size - sizeof(header);
  switch (static_cast<OniRecord>(header.type)) {
    case OniRecord::kNewData:
      return fields == sizeof(FrameFields);
    case OniRecord::kSeekTable:
      return fields == 0;
    case OniRecord::kNodeRemoved:
    case OniRecord::kEnd:
      return fields == 0 && header.payload_size == 0;
    default:
      return false;
  }
}

// A damaged length also points beyond the end: a truncated file does not end like a complete one.
OniEnd EndBeyond(std::ifstream& file, uint64_t size) {
  const auto last = ReadAt<OniRecordHeader>(file, size - sizeof(OniRecordHeader));
  return last && EndsARecording(*last) ? OniEnd::kDamaged : OniEnd::kCut;
}

bool Follows(const std::vector<OniFrameAt>& frames, const FrameFields& fields) {
  return fields.number == frames.size() + 1 &&
         (frames.empty() || fields.timestamp_us > frames.back().timestamp_us);
}

}  // namespace

OniFrames FindOniFrames(std::ifstream& file, uint64_t begin) {
  const uint64_t size = MeasureSize(file);
  OniFrames found;
  for (uint64_t at = begin;;) {
    const auto header = ReadAt<OniRecordHeader>(file, at);
    if (!header) return {std::move(found.frames), EndBeyond(file, size)};
    if (!IsKnown(*header)) return found;
    const uint64_t data_at = at + header->fields_size;
    const uint64_t end = data_at + header->payload_size;
    if (end > size) return {std::move(found.frames), EndBeyond(file, size)};
    if (EndsARecording(*header)) {
      found.end = end == size ? OniEnd::kWhole : OniEnd::kDamaged;
      return found;
    }
    if (header->type == static_cast<uint32_t>(OniRecord::kNewData)) {
      const auto fields = ReadAt<FrameFields>(file, at + sizeof(OniRecordHeader));
      if (!fields || !Follows(found.frames, *fields)) return found;
      found.frames.push_back({fields->timestamp_us, data_at, header->payload_size});
    }
    at = end;
  }
}

}  // namespace ossa::depth
