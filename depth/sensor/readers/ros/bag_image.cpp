#include "depth/sensor/readers/ros/bag_image.h"

#include <cstring>
#include <limits>
#include <string>

#include "depth/base/error.h"
#include "depth/image/png_codec_internal.h"

namespace ossa::depth {
namespace {

// Numbers of variable length: three bits in each nibble, whose first bit is set if another follows;
// eight nibbles in a little-endian word, the first one in its highest bits.
class RvlNumbers {
 public:
  explicit RvlNumbers(std::span<const uint8_t> bytes) : words_(bytes, RosWire::kRos1) {}

  uint32_t Next() {
    constexpr int kBits = 32, kBitsOfNibble = 3;  // RVL's format
    uint32_t value = 0;
    for (int shift = 0; shift < kBits; shift += kBitsOfNibble) {
      const uint32_t nibble = NextNibble();
      value |= (nibble & 7U) << shift;
      if ((nibble & 8U) == 0) return value;
    }
    throw InputError("a message: expected RVL, found a number of more than 32 bits");
  }

 private:
  uint32_t NextNibble() {
    constexpr int kNibbles = 8, kBits = 4;  // of a word, RVL's format
    if (left_ == 0) {
      word_ = words_.Value<uint32_t>();
      left_ = kNibbles;
    }
    --left_;
    const uint32_t nibble = word_ >> (kBits * (kNibbles - 1));
    word_ <<= kBits;
    return nibble;
  }

  RosFields words_;
  uint32_t word_ = 0;
  int left_ = 0;  // nibbles of the word
};

// Runs of pixels without a reading and of such with one; of these the differences to the one
// before, with the sign in the lowest bit.
std::vector<uint16_t> DecodeRvl(std::span<const uint8_t> bytes, size_t count) {
  std::vector<uint16_t> depths(count);
  RvlNumbers numbers(bytes);
  uint32_t depth = 0;
  for (size_t i = 0; i < count;) {
    const size_t empty = numbers.Next(), full = numbers.Next();
    if (empty > count - i || full > count - i - empty || empty + full == 0) {
      throw InputError("a message: expected RVL of " + std::to_string(count) +
                       " pixels, found runs of others");
    }
    i += empty;
    for (const size_t end = i + full; i < end; ++i) {
      const uint32_t step = numbers.Next();
      depth += (step >> 1) ^ (0U - (step & 1U));
      depths[i] = static_cast<uint16_t>(depth);
    }
  }
  return depths;
}

template <typename Sample>
void SetSamples(const std::vector<Sample>& samples, BagImage& to) {
  const auto bytes = std::as_bytes(std::span(samples));
  to.unpacked.resize(bytes.size());
  std::memcpy(to.unpacked.data(), bytes.data(), bytes.size());
  to.image.step = to.image.width * static_cast<uint32_t>(sizeof(Sample));
  to.image.data = to.unpacked;
}

std::vector<uint16_t> DecodePng(std::span<const uint8_t> png, RosImage& image) {
  std::vector<uint8_t> bytes;
  const ImageSize size = DecodeGreyPng(png, 16, "a message", &bytes);
  image.width = static_cast<uint32_t>(size.width);
  image.height = static_cast<uint32_t>(size.height);
  std::vector<uint16_t> samples(bytes.size() / sizeof(uint16_t));
  std::memcpy(samples.data(), bytes.data(), bytes.size());
  return samples;
}

// image_transport's ConfigHeader: how inverse depths are quantised.
struct Quantisation {
  float a = 0.0F, b = 0.0F;  // depth in metres: a / (value - b)
};

std::vector<float> MetresOf(const std::vector<uint16_t>& inverses, const Quantisation& by) {
  std::vector<float> metres(inverses.size(), std::numeric_limits<float>::quiet_NaN());
  for (size_t i = 0; i < inverses.size(); ++i) {
    if (inverses[i] != 0) metres[i] = by.a / (static_cast<float>(inverses[i]) - by.b);
  }
  return metres;
}

std::vector<uint16_t> DecodeRvlImage(RosFields& fields, RosImage& image, size_t size) {
  constexpr size_t kSize = 2 * sizeof(uint32_t);
  image.width = fields.Value<uint32_t>();
  image.height = fields.Value<uint32_t>();
  constexpr uint32_t kLargest = kLargestImageSide;
  if (image.width == 0 || image.height == 0 || image.width > kLargest || image.height > kLargest) {
    throw InputError("a message: expected an image of at most " + std::to_string(kLargest) +
                     " pixels a side, found " + std::to_string(image.width) + "x" +
                     std::to_string(image.height));
  }
  return DecodeRvl(fields.Bytes(size - kSize), size_t{image.width} * image.height);
}

// compressedDepth: a ConfigHeader, then the image.
void UnpackDepth(const RosCompressedImage& packed, bool is_rvl, BagImage& to) {
  constexpr size_t kHeader = sizeof(uint32_t) + sizeof(Quantisation);
  RosFields fields(packed.data, RosWire::kRos1);
  fields.Value<uint32_t>();  // the format, which the message's text states
  const auto quantisation = Quantisation{fields.Value<float>(), fields.Value<float>()};
  const size_t size = packed.data.size() - kHeader;
  const auto samples =
      is_rvl ? DecodeRvlImage(fields, to.image, size) : DecodePng(fields.Bytes(size), to.image);
  if (ParseDepthEncoding(to.image) == RosDepth::kMetres) {
    SetSamples(MetresOf(samples, quantisation), to);
  } else {
    SetSamples(samples, to);
  }
}

bool Has(const std::string& text, const char* word) { return text.find(word) != std::string::npos; }

BagImage ReadCompressed(const RosCompressedImage& packed) {
  BagImage read;
  read.image.time_s = packed.time_s;
  read.image.encoding = packed.format.substr(0, packed.format.find(';'));
  if (ParseDepthEncoding(read.image) == RosDepth::kNone) return read;
  if (Has(packed.format, "compressedDepth")) {
    UnpackDepth(packed, Has(packed.format, "rvl"), read);
  } else if (Has(packed.format, "png")) {
    SetSamples(DecodePng(packed.data, read.image), read);
  } else {
    read.image.encoding = packed.format;
  }
  return read;
}

}  // namespace

BagImage ReadBagImage(const BagTopic& topic, std::span<const uint8_t> message) {
  if (topic.type == "sensor_msgs/CompressedImage") {
    return ReadCompressed(ParseRosCompressedImage(message, topic.wire));
  }
  return {ParseRosImage(message, topic.wire), {}};
}

}  // namespace ossa::depth
