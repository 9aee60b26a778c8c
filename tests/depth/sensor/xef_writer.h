#pragma once
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace ossa::test {

/// Writes recordings as Kinect Studio does, by KinectXEFTools' description of the format.
class XefWriter {
 public:
  /// Archived as by KSConvert: events are compressed, and the number of streams is not stated.
  explicit XefWriter(bool is_archived = false) : is_archived_(is_archived) {
    bytes_.assign("EVENTS1\0", 8);
    Append<uint32_t>(5);
    Append<uint32_t>(0);  // streams
    Append<uint64_t>(0);
    AppendEvent(0, 0, 0, std::string(24, 't'), "Properties");
  }

  /// Types of streams, as they are stored.
  static inline const std::string kDepth =
      "\xd6\x14\x39\x0a\x16\x3b\xe1\x11\xaa\xc3" + std::string(1, '\0') + "\x1e\x4f\xd5\x8c\x0f";
  static inline const std::string kInfrared = "\xd7" + kDepth.substr(1);
  static inline const std::string kBodies =
      "\x79\x51\xc4\xa0\x68\x51\x75\x48\xa7\x5c\xf8\xf1\x76\x0f\x63\x7c";

  XefWriter& AddStream(uint16_t index, const std::string& name, const std::string& type) {
    const uint16_t flags = is_archived_ ? 1 : 0;
    const std::string tag = Number(index) + Number(flags) + type;
    std::string data;
    for (const char letter : name) data += {letter, '\0'};
    data.resize(258);
    data += Number<uint16_t>(4);  // the tag's bytes
    data.resize(292);
    AppendEvent(index, flags, 0, tag + std::string(4, '\0'), data);
    if (is_archived_) bytes_ += "\x78\x01......";
    AppendEvent(0, 0, 0, std::string(24, 'g'), std::string(98, 'g'));
    streams_ = std::max(streams_, index);
    return *this;
  }

  template <typename T>
  XefWriter& AddEvent(uint16_t stream, uint64_t ticks, uint32_t number,
                      const std::vector<T>& numbers) {
    const std::string data(reinterpret_cast<const char*>(numbers.data()),
                           sizeof(T) * numbers.size());
    AppendEvent(stream, is_archived_ ? 1 : 0, ticks, Number(number), data);
    return *this;
  }

  /// A record of unknown content, as lies between events.
  XefWriter& AddUnknown(size_t bytes) {
    bytes_ += std::string("\xff\xff\0\0", 4) + std::string(bytes - 4, '\x05');
    return *this;
  }

  std::string Finish() {
    std::string whole = bytes_;
    const auto footer = static_cast<uint16_t>(streams_ + 1);
    if (!is_archived_) whole.replace(12, 4, Number<uint32_t>(footer));
    return whole + Number(footer) + std::string(0x6b0, '\xff');
  }

 private:
  template <typename T>
  static std::string Number(T number) {
    return {reinterpret_cast<const char*>(&number), sizeof(T)};
  }
  template <typename T>
  void Append(T number) {
    bytes_ += Number(number);
  }

  void AppendEvent(uint16_t stream, uint16_t flags, uint64_t ticks, const std::string& tag,
                   const std::string& data) {
    const bool is_packed = flags == 1 && tag.size() == 4;
    const std::string stored = is_packed ? Packed(data) : data;
    Append(stream);
    Append(flags);
    Append(static_cast<uint32_t>(stored.size()));
    Append(ticks);
    Append<uint32_t>(0);
    Append(static_cast<uint32_t>(data.size()));
    bytes_ += tag + stored;
  }

  static std::string Packed(const std::string& data) {
    uLongf size = compressBound(data.size());
    std::string packed(size, '\0');
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
              reinterpret_cast<const Bytef*>(data.data()), data.size(), 1);
    packed.resize(size);
    return packed;
  }

  bool is_archived_;
  uint16_t streams_ = 0;
  std::string bytes_;
};

}  // namespace ossa::test
