// Neighbouring pixels of a surface carry the same part, but a tree answers each by itself, and its
// errors scatter like salt and pepper: averaging P(c | I, x) over a patch of about 5 cm takes them
// out. Departure from Shotton et al. 2011, whose per-pixel answers go to mean shift directly.
// Prefix sums along rows and columns make the cost independent of the patch's size. Only as many
// rows are held as a window is high: they stay in the cache.
#include "forest/smooth_internal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "forest/clones_internal.h"

namespace ossa::forest {
namespace {

constexpr int kGap_mm = 50;    // between neighbours: an arm before the trunk
constexpr size_t kBlock = 16;  // masses that the vector units take at once
constexpr int32_t kNone = -1;

int DepthAt(const ObjectImage& image, int32_t position) {
  return image.depth_mm[image.At(position & 0xffff, position >> 16)];
}

// 65535 / width: a table spares the division, and the vector units multiply 16 bits by 16.
constexpr auto kShareOfWidth = [] {
  std::array<uint16_t, 2 * kMaxSmoothRadius_px + 2> share{};
  for (size_t width = 1; width < share.size(); ++width) {
    share[width] = static_cast<uint16_t>(65535 / width);
  }
  return share;
}();

// Rows of masses of the latest pixels, by the pixel's number.
struct Ring {
  size_t stride = 0;
  size_t capacity = 0;         // a power of two
  std::vector<uint16_t> rows;  // and one more of zeros, that of no pixel

  Ring(size_t pixels, size_t row_stride)
      : stride(row_stride), capacity(std::bit_ceil(pixels)), rows((capacity + 1) * stride) {}
  size_t At(int32_t pixel) const {
    return (pixel == kNone ? capacity : static_cast<size_t>(pixel) & (capacity - 1)) * stride;
  }
};

using Block = uint16_t __attribute__((vector_size(2 * kBlock)));
using ByteBlock = uint8_t __attribute__((vector_size(kBlock)));

// sum[i] = sum[i - 1] + mass[from[i]] along one run; sum has one row more, the first of zeros.
OSSA_CLONES void PrefixRun(const uint8_t* mass, std::span<const int32_t> from, size_t stride,
                           uint16_t* sum) {
  std::fill_n(sum, stride, uint16_t{0});
  for (size_t b = 0; b < stride; b += kBlock) {
    Block total = {};
    for (size_t i = 0; i < from.size(); ++i) {
      ByteBlock add;
      std::memcpy(&add, mass + static_cast<size_t>(from[i]) * stride + b, sizeof(ByteBlock));
      total += __builtin_convertvector(add, Block);
      std::memcpy(sum + (i + 1) * stride + b, &total, sizeof(Block));
    }
  }
}

// Means over windows of a run that begins with pixel `first`, times four, added to the sums of the
// pixels above.
OSSA_CLONES void AverageRun(const uint16_t* sum, int radius, int32_t first,
                            std::span<const int32_t> up, Ring* ring) {
  const auto count = static_cast<int>(up.size());
  const size_t stride = ring->stride;
  for (int i = 0; i < count; ++i) {
    const int begin = std::max(0, i - radius);
    const int end = std::min(count, i + radius + 1);
    const uint16_t share = kShareOfWidth[static_cast<size_t>(end - begin)];
    const uint16_t* low = sum + static_cast<size_t>(begin) * stride;
    const uint16_t* high = sum + static_cast<size_t>(end) * stride;
    const uint16_t* above = ring->rows.data() + ring->At(up[static_cast<size_t>(i)]);
    uint16_t* to = ring->rows.data() + ring->At(first + i);
    for (size_t b = 0; b < stride; b += kBlock) {
      uint16_t mean[kBlock];
      for (size_t c = 0; c < kBlock; ++c) {
        const auto within = static_cast<uint16_t>(high[b + c] - low[b + c]);
        mean[c] = static_cast<uint16_t>(within << 2U);
      }
      for (uint16_t& m : mean) m = static_cast<uint16_t>((static_cast<uint32_t>(m) * share) >> 16U);
      for (size_t c = 0; c < kBlock; ++c) mean[c] = static_cast<uint16_t>(mean[c] + above[b + c]);
      std::copy_n(mean, kBlock, to + b);
    }
  }
}

// out = high - low, modulo 2^16; returns the largest.
inline uint16_t Subtract(const uint16_t* high, const uint16_t* low, size_t stride, uint16_t* out) {
  Block most = {};
  for (size_t b = 0; b < stride; b += kBlock) {
    Block minuend, subtrahend;
    std::memcpy(&minuend, high + b, sizeof(Block));
    std::memcpy(&subtrahend, low + b, sizeof(Block));
    const Block mass = minuend - subtrahend;
    most = mass > most ? mass : most;
    std::memcpy(out + b, &mass, sizeof(Block));
  }
  std::array<uint16_t, kBlock> lane;
  std::memcpy(lane.data(), &most, sizeof(Block));
  uint16_t largest = 0;
  for (const uint16_t mass : lane) largest = mass > largest ? mass : largest;
  return largest;
}

inline uint16_t FirstColumnOf(uint16_t wanted, const uint16_t* mass, size_t stride) {
  Block number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  Block first = ~Block{};
  for (size_t b = 0; b < stride; b += kBlock, number += kBlock) {
    Block here;
    std::memcpy(&here, mass + b, sizeof(Block));
    const Block column = here == wanted ? number : ~Block{};
    first = column < first ? column : first;
  }
  std::array<uint16_t, kBlock> lane;
  std::memcpy(lane.data(), &first, sizeof(Block));
  uint16_t least = 0xffff;
  for (const uint16_t column : lane) least = column < least ? column : least;
  return least;
}

// out = sums at `high` - sums at `low`; label = the first of the largest columns + 1.
OSSA_CLONES void Conclude(const Ring& ring, std::span<const std::array<int32_t, 2>> high_low,
                          uint16_t* out, uint8_t* label) {
  for (const auto& [high, low] : high_low) {
    const uint16_t* rows = ring.rows.data();
    const uint16_t largest = Subtract(rows + ring.At(high), rows + ring.At(low), ring.stride, out);
    *label++ = static_cast<uint8_t>(largest > 0 ? FirstColumnOf(largest, out, ring.stride) + 1 : 0);
    out += ring.stride;
  }
}

// Where each pixel's column goes on, on the same surface.
struct Columns {
  std::vector<int32_t> index;          // of box positions: the pixel there
  std::vector<int32_t> up;             // a pixel's neighbour above; or kNone
  std::vector<uint16_t> above, below;  // how many follow each way
};

Columns LinkColumns(const MassImage& masses) {
  const ObjectImage& image = *masses.image;
  const size_t count = masses.position.size();
  const auto width = static_cast<size_t>(image.width);
  Columns columns;
  columns.index.assign(width * static_cast<size_t>(image.height), kNone);
  columns.up.assign(count, kNone);
  columns.above.assign(count, 0);
  columns.below.assign(count, 0);
  for (size_t i = 0; i < count; ++i) {
    const int32_t p = masses.position[i];
    const size_t at = static_cast<size_t>(p >> 16) * width + static_cast<size_t>(p & 0xffff);
    columns.index[at] = static_cast<int32_t>(i);
    if (at < width || columns.index[at - width] == kNone) continue;
    const int32_t up = columns.index[at - width];
    const int there_mm = DepthAt(image, masses.position[static_cast<size_t>(up)]);
    if (std::abs(DepthAt(image, p) - there_mm) > kGap_mm) continue;
    columns.up[i] = up;
    columns.above[i] = static_cast<uint16_t>(columns.above[static_cast<size_t>(up)] + 1);
  }
  for (size_t i = count; i-- > 0;) {
    if (columns.up[i] == kNone) continue;
    columns.below[static_cast<size_t>(columns.up[i])] = static_cast<uint16_t>(columns.below[i] + 1);
  }
  return columns;
}

// The first pixel of each row of the box, and one past the last of all.
std::vector<size_t> RowBegins(const MassImage& masses) {
  std::vector<size_t> begin(static_cast<size_t>(masses.image->height) + 1, 0);
  for (const int32_t p : masses.position) ++begin[static_cast<size_t>(p >> 16) + 1];
  for (size_t y = 1; y < begin.size(); ++y) begin[y] += begin[y - 1];
  return begin;
}

// Pixels in as many rows as must be held at once: a window, the row above it and the newest.
size_t MostHeld(const std::vector<size_t>& row_begin, int radius) {
  const auto rows = static_cast<size_t>(2 * radius + 2);
  size_t most = 1;
  for (size_t y = 1; y < row_begin.size(); ++y) {
    most = std::max(most, row_begin[y] - row_begin[y > rows ? y - rows : 0]);
  }
  return most;
}

class Smoother {
 public:
  Smoother(const MassImage& masses, int radius)
      : masses_(masses),
        radius_(radius),
        columns_(LinkColumns(masses)),
        row_begin_(RowBegins(masses)),
        ring_(MostHeld(row_begin_, radius), masses.stride),
        sum_(static_cast<size_t>(masses.image->width + 1) * masses.stride) {
    result_.mass.resize(masses.sparse->position.size() * masses.stride);
    result_.label.resize(masses.position.size());
  }

  SmoothMasses Run() {
    const int height = masses_.image->height;
    for (int y = 0; y < height + radius_; ++y) {
      if (y < height) AverageRow(static_cast<size_t>(y));
      if (y >= radius_) ConcludeRow(static_cast<size_t>(y - radius_));
    }
    return std::move(result_);
  }

 private:
  // Runs of a row end where the object does or the depth jumps.
  void AverageRow(size_t y) {
    const auto& position = masses_.position;
    for (size_t begin = row_begin_[y], end; begin < row_begin_[y + 1]; begin = end) {
      int depth_mm = DepthAt(*masses_.image, position[begin]);
      for (end = begin + 1; end < row_begin_[y + 1]; ++end) {
        if (position[end] != position[end - 1] + 1) break;
        const int next_mm = DepthAt(*masses_.image, position[end]);
        if (std::abs(next_mm - depth_mm) > kGap_mm) break;
        depth_mm = next_mm;
      }
      PrefixRun(masses_.mass, std::span(masses_.sparse->from).subspan(begin, end - begin),
                masses_.stride, sum_.data());
      AverageRun(sum_.data(), radius_, static_cast<int32_t>(begin),
                 std::span(columns_.up).subspan(begin, end - begin), &ring_);
    }
  }

  void ConcludeRow(size_t y) {
    const int width = masses_.image->width;
    const size_t begin = row_begin_[y];
    high_low_.clear();
    for (size_t i = begin; i < row_begin_[y + 1]; ++i) {
      const int32_t p = masses_.position[i];
      const int at = (p >> 16) * width + (p & 0xffff);
      const int down = std::min<int>(radius_, columns_.below[i]);
      const int32_t high = columns_.index[static_cast<size_t>(at + down * width)];
      const bool goes_on = columns_.above[i] > radius_;
      high_low_.push_back(
          {high,
           goes_on ? columns_.index[static_cast<size_t>(at - (radius_ + 1) * width)] : kNone});
    }
    // The sums along the row are done with: their place serves.
    Conclude(ring_, high_low_, sum_.data(), result_.label.data() + begin);
    for (size_t k = 0; k < high_low_.size(); ++k) {
      const auto sample = static_cast<size_t>(masses_.sparse->from[begin + k]);
      if (masses_.sparse->position[sample] != masses_.position[begin + k]) continue;
      std::copy_n(sum_.data() + k * masses_.stride, masses_.stride,
                  result_.mass.data() + sample * masses_.stride);
    }
  }

  const MassImage& masses_;
  int radius_;
  Columns columns_;
  std::vector<size_t> row_begin_;
  Ring ring_;                                     // sums down the columns, modulo 2^16
  std::vector<uint16_t> sum_;                     // along a run
  std::vector<std::array<int32_t, 2>> high_low_;  // of a row: the ends of each pixel's window
  SmoothMasses result_;
};

}  // namespace

SmoothMasses Smooth(const MassImage& masses, int radius_px) {
  return Smoother(masses, std::clamp(radius_px, 0, kMaxSmoothRadius_px)).Run();
}

}  // namespace ossa::forest
