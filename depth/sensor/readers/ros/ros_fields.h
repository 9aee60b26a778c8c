#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "depth/base/error.h"

namespace ossa::depth {

inline constexpr double kSecondsPerNanosecond = 1e-9;

/// Serialization of messages.
enum class RosWire {
  kRos1,  // wiki.ros.org/msg: little-endian, packed
  kCdr,   // ROS 2's: OMG CDR after an encapsulation header (DDS-XTypes 1.3, 7.4)
};

/// The fields of a ROS message, read in order. Strings and sequences are preceded by their length.
/// In CDR, numbers are aligned to their size, and strings end in a zero byte. All throw InputError
/// for truncated messages.
class RosFields {
 public:
  RosFields(std::span<const uint8_t> message, RosWire wire) : rest_(message), wire_(wire) {
    if (wire == RosWire::kCdr) ReadEncapsulation();
  }

  std::span<const uint8_t> Bytes(size_t size) {
    if (size > rest_.size()) {
      throw InputError("a message: expected " + std::to_string(size) + " more bytes, found " +
                       std::to_string(rest_.size()));
    }
    const auto taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    at_ += size;
    return taken;
  }

  template <typename T>
  T Value() {
    Align(sizeof(T));
    std::array<uint8_t, sizeof(T)> bytes;
    std::copy_n(Bytes(sizeof(T)).begin(), sizeof(T), bytes.begin());
    if (is_swapped_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  template <typename T, size_t kCount>
  std::array<T, kCount> Values() {
    std::array<T, kCount> values{};
    for (T& value : values) value = Value<T>();
    return values;
  }

  /// A sequence of bytes.
  std::span<const uint8_t> ByteSequence() { return Bytes(Value<uint32_t>()); }

  template <typename T>
  std::vector<T> Sequence() {
    const size_t count = Value<uint32_t>();
    if (count > rest_.size() / sizeof(T)) Bytes(count * sizeof(T));  // throws
    std::vector<T> values(count);
    for (T& value : values) value = Value<T>();
    return values;
  }

  std::string Text() {
    auto text = ByteSequence();
    if (wire_ == RosWire::kCdr && !text.empty() && text.back() == 0)
      text = text.first(text.size() - 1);
    return {reinterpret_cast<const char*>(text.data()), text.size()};
  }

  /// std_msgs/Header: its stamp, seconds.
  double Header() {
    if (wire_ == RosWire::kRos1) Value<uint32_t>();  // seq
    const auto seconds = Value<uint32_t>(), nanoseconds = Value<uint32_t>();
    Text();  // frame_id
    return seconds + kSecondsPerNanosecond * nanoseconds;
  }

 private:
  static_assert(std::endian::native == std::endian::little);

  // Identifiers of DDS-XTypes 1.3, table 60: the last bit is set for little-endian.
  void ReadEncapsulation() {
    constexpr uint8_t kCdr1 = 0, kPlainCdr2 = 6;  // the standard's
    const auto header = Bytes(4);
    const uint8_t kind = header[1] & 0xFE;
    if (header[0] != 0 || (kind != kCdr1 && kind != kPlainCdr2)) {
      throw InputError("a message: expected plain CDR, found encapsulation " +
                       std::to_string(256 * header[0] + header[1]));
    }
    is_swapped_ = (header[1] & 1) == 0;
    widest_alignment_ = kind == kCdr1 ? 8 : 4;
    at_ = 0;
  }

  void Align(size_t size) {
    if (wire_ != RosWire::kCdr) return;
    const size_t alignment = std::min(size, widest_alignment_);
    Bytes((alignment - at_ % alignment) % alignment);
  }

  std::span<const uint8_t> rest_;
  RosWire wire_;
  size_t at_ = 0;                // from which CDR aligns, bytes
  size_t widest_alignment_ = 8;  // bytes
  bool is_swapped_ = false;
};

}  // namespace ossa::depth
