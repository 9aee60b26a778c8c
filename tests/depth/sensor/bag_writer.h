#pragma once
// Messages of any type, by their bytes, for rosbag::Bag::write.
#include <rosbag/bag.h>

#include <cstring>
#include <string>
#include <vector>

namespace ossa::test {

struct RawMessage {
  std::string type;
  std::vector<uint8_t> bytes;
};

}  // namespace ossa::test

namespace ros {
namespace message_traits {
template <>
struct IsMessage<ossa::test::RawMessage> : TrueType {};
template <>
struct MD5Sum<ossa::test::RawMessage> {
  static const char* value(const ossa::test::RawMessage&) { return "*"; }
  static const char* value() { return "*"; }
};
template <>
struct DataType<ossa::test::RawMessage> {
  static const char* value(const ossa::test::RawMessage& message) { return message.type.c_str(); }
  static const char* value() { return "*"; }
};
template <>
struct Definition<ossa::test::RawMessage> {
  static const char* value(const ossa::test::RawMessage&) { return ""; }
  static const char* value() { return ""; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<ossa::test::RawMessage> {
  template <typename Stream>
  static void write(Stream& stream, const ossa::test::RawMessage& message) {
    const auto size = static_cast<uint32_t>(message.bytes.size());
    std::memcpy(stream.advance(size), message.bytes.data(), size);
  }
  static uint32_t serializedLength(const ossa::test::RawMessage& message) {
    return static_cast<uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros
