#include <cstdlib>

#include "depth/sensor/oni_codec_internal.h"

namespace ossa::depth {
namespace {

void Put16(uint16_t value, std::vector<uint8_t>* out) {
  out->push_back(static_cast<uint8_t>(value & 0xff));
  out->push_back(static_cast<uint8_t>(value >> 8));
}

// The stream's grammar, by the first byte:
//   0xAB, A and B at most 12: two pixels, position -= A - 6, then -= B - 6
//   0xAD, D = 13:             one pixel (the last of an odd number)
//   0xAF, F = 15:             one pixel, then a jump
//   0xFF:                     a jump
//   0xEn:                     2n pixels like the one before
// and a jump is one byte with the top bit set, position -= byte - 192, or the new position in two
// bytes, high byte first (hence at most 15 bits).
class DifferenceStream {
 public:
  explicit DifferenceStream(std::vector<uint8_t>* out) : out_(out) {}

  void Put(int difference, int position) {
    if (std::abs(difference) > 6) {
      PutJump(difference, position);
    } else if (!has_half_) {
      half_ = static_cast<uint8_t>((difference + 6) << 4);
      has_half_ = true;
    } else {
      PutPair(static_cast<uint8_t>(half_ + difference + 6));
    }
  }

  // Departure: OpenNI2's own encoder writes an odd last pixel before the preceding run of equal
  // pairs, and so decodes the last pixels of such frames wrongly.
  void Finish() {
    FlushRun();
    if (has_half_) out_->push_back(static_cast<uint8_t>(half_ + 0x0d));
  }

 private:
  void PutPair(uint8_t pair) {
    has_half_ = false;
    if (pair == 0x66) {
      if (++run_ == 15) FlushRun();
      return;
    }
    FlushRun();
    out_->push_back(pair);
  }

  void PutJump(int difference, int position) {
    FlushRun();
    out_->push_back(has_half_ ? static_cast<uint8_t>(half_ + 0x0f) : uint8_t{0xff});
    has_half_ = false;
    if (std::abs(difference) <= 63) {
      out_->push_back(static_cast<uint8_t>(difference + 192));
    } else {
      out_->push_back(static_cast<uint8_t>(position >> 8));
      out_->push_back(static_cast<uint8_t>(position & 0xff));
    }
  }

  void FlushRun() {
    if (run_ > 0) out_->push_back(static_cast<uint8_t>(0xe0 + run_));
    run_ = 0;
  }

  std::vector<uint8_t>* out_;
  uint8_t half_ = 0;
  bool has_half_ = false;
  int run_ = 0;  // pending pairs of pixels equal to the previous one
};

// The decoder: hostile bytes cannot index outside the stream, the table or the image.
class DifferenceReader {
 public:
  DifferenceReader(std::span<const uint8_t> data, std::span<const uint16_t> table, int position)
      : data_(data), table_(table), position_(position) {}

  // True if the stream holds exactly `pixels` pixels.
  bool Read(size_t pixels, std::vector<uint16_t>* depth_mm) {
    out_ = depth_mm;
    pixels_ = pixels;
    if (!PutPixel()) return false;
    while (out_->size() < pixels_) {
      if (!ReadCode()) return false;
    }
    return at_ == data_.size();
  }

 private:
  bool ReadCode() {
    if (at_ == data_.size()) return false;
    const int high = data_[at_] >> 4, low = data_[at_] & 0x0f;
    ++at_;
    if (high == 0x0f) return low == 0x0f && Jump();
    if (high == 0x0e) return Repeat(2 * low);
    if (high > 12 || !Step(high)) return false;
    if (low == 0x0d) return true;
    if (low == 0x0f) return Jump();
    return low <= 12 && Step(low);
  }

  bool PutPixel() {
    if (position_ < 0 || static_cast<size_t>(position_) >= table_.size()) return false;
    if (out_->size() == pixels_) return false;
    out_->push_back(table_[static_cast<size_t>(position_)]);
    return true;
  }
  bool Step(int half) {
    position_ -= half - 6;
    return PutPixel();
  }
  bool Repeat(int count) {
    for (int i = 0; i < count; ++i) {
      if (!PutPixel()) return false;
    }
    return count > 0;
  }
  bool Jump() {
    if (at_ == data_.size()) return false;
    const int byte = data_[at_++];
    if ((byte & 0x80) != 0) {
      position_ -= byte - 192;
      return PutPixel();
    }
    if (at_ == data_.size()) return false;
    position_ = byte << 8 | data_[at_++];
    return PutPixel();
  }

  std::span<const uint8_t> data_;
  std::span<const uint16_t> table_;
  int position_;
  size_t at_ = 0;
  size_t pixels_ = 0;
  std::vector<uint16_t>* out_ = nullptr;
};

uint16_t Value16(std::span<const uint8_t> data, size_t at) {
  return static_cast<uint16_t>(data[at] | data[at + 1] << 8);
}

}  // namespace

bool EncodeOniDepth(std::span<const uint16_t> depth_mm, std::vector<uint8_t>* out) {
  if (depth_mm.empty()) return false;
  std::vector<uint8_t> occurs(65536, 0);
  for (const uint16_t value : depth_mm) occurs[value] = 1;

  const size_t table_at = out->size();
  Put16(0, out);
  std::vector<uint16_t> position_of(65536, 0);
  int count = 0;
  for (int value = 0; value < 65536; ++value) {
    if (occurs[static_cast<size_t>(value)] == 0) continue;
    if (count == kLargestOniTable) return false;
    position_of[static_cast<size_t>(value)] = static_cast<uint16_t>(count++);
    Put16(static_cast<uint16_t>(value), out);
  }
  (*out)[table_at] = static_cast<uint8_t>(count & 0xff);
  (*out)[table_at + 1] = static_cast<uint8_t>(count >> 8);

  int last = position_of[depth_mm[0]];
  Put16(static_cast<uint16_t>(last), out);
  DifferenceStream stream(out);
  for (const uint16_t value : depth_mm.subspan(1)) {
    const int position = position_of[value];
    stream.Put(last - position, position);
    last = position;
  }
  stream.Finish();
  return true;
}

bool DecodeOniDepth(std::span<const uint8_t> data, size_t pixels, std::vector<uint16_t>* depth_mm) {
  depth_mm->clear();
  constexpr size_t kValue = sizeof(uint16_t);
  if (data.size() < kValue) return false;
  const size_t count = Value16(data, 0);
  if (count > kLargestOniTable || data.size() < (count + 2) * kValue) return false;
  std::vector<uint16_t> table(count);
  for (size_t i = 0; i < count; ++i) table[i] = Value16(data, (i + 1) * kValue);
  const int first = Value16(data, (count + 1) * kValue);
  depth_mm->reserve(pixels);
  return DifferenceReader(data.subspan((count + 2) * kValue), table, first).Read(pixels, depth_mm);
}

}  // namespace ossa::depth
