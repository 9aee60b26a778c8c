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

constexpr size_t kBlock = 16;  // masses that the vector units take at once
constexpr int32_t kNone = SparsePixels::kNone;

// 65535 / width: a table spares the division, and the vector units multiply 16 bits by 16.
constexpr auto kShareOfWidth = [] {
  std::array<uint16_t, 2 * kMaxSmoothRadius + 2> share{};
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

// sum[i] = sum[i - 1] + mass[sample[i]] along one run; sum has one row more, the first of zeros.
OSSA_CLONES void PrefixRun(const uint8_t* mass, std::span<const int32_t> sample, size_t stride,
                           uint16_t* sum) {
  std::fill_n(sum, stride, uint16_t{0});
  for (size_t b = 0; b < stride; b += kBlock) {
    Block total = {};
    for (size_t i = 0; i < sample.size(); ++i) {
      ByteBlock add;
      std::memcpy(&add, mass + static_cast<size_t>(sample[i]) * stride + b, sizeof(ByteBlock));
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

// The first of a row's largest columns + 1; 0 where there is no mass.
inline uint8_t LabelOf(const uint16_t* mass, size_t stride) {
  std::array<uint16_t, kBlock> lane;
  Block most = {};
  for (size_t b = 0; b < stride; b += kBlock) {
    Block here;
    std::memcpy(&here, mass + b, sizeof(Block));
    most = here > most ? here : most;
  }
  std::memcpy(lane.data(), &most, sizeof(Block));
  const uint16_t largest = *std::max_element(lane.begin(), lane.end());
  if (largest == 0) return 0;
  Block number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  Block first = ~Block{};
  for (size_t b = 0; b < stride; b += kBlock, number += kBlock) {
    Block here;
    std::memcpy(&here, mass + b, sizeof(Block));
    const Block column = here == largest ? number : ~Block{};
    first = column < first ? column : first;
  }
  std::memcpy(lane.data(), &first, sizeof(Block));
  return static_cast<uint8_t>(*std::min_element(lane.begin(), lane.end()) + 1);
}

// out = sums at `high` - sums at `low`, modulo 2^16, and its label.
OSSA_CLONES void Conclude(const Ring& ring, std::span<const std::array<int32_t, 2>> high_low,
                          uint16_t* out, uint8_t* label) {
  const uint16_t* rows = ring.rows.data();
  for (const auto& [high, low] : high_low) {
    const uint16_t* minuend = rows + ring.At(high);
    const uint16_t* subtrahend = rows + ring.At(low);
    for (size_t c = 0; c < ring.stride; ++c) {
      out[c] = static_cast<uint16_t>(minuend[c] - subtrahend[c]);
    }
    *label++ = LabelOf(out, ring.stride);
    out += ring.stride;
  }
}

// The samples on the grid, in raster order: what follows numbers them so.
struct Raster {
  std::vector<int32_t> position;  // y << 16 | x, of the grid
  std::vector<int32_t> sample;
  std::vector<size_t> row_begin;  // the first of each row, and one past the last of all
  std::vector<int32_t> index;     // of a cell: its number here; or kNone
};

Raster RasterOf(const SparsePixels& sparse) {
  Raster raster;
  raster.index.assign(sparse.sample.size(), kNone);
  for (int y = 0; y < sparse.grid.height; ++y) {
    raster.row_begin.push_back(raster.position.size());
    for (int x = 0; x < sparse.grid.width; ++x) {
      const int32_t sample = sparse.SampleAt(x, y);
      if (sample == kNone) continue;
      raster.index[static_cast<size_t>(y * sparse.grid.width + x)] =
          static_cast<int32_t>(raster.position.size());
      raster.position.push_back((y << 16) | x);
      raster.sample.push_back(sample);
    }
  }
  raster.row_begin.push_back(raster.position.size());
  return raster;
}

// Where each sample's column goes on, on the same surface.
struct Columns {
  std::vector<int32_t> up;             // its neighbour above; or kNone
  std::vector<uint16_t> above, below;  // how many follow each way
};

Columns LinkColumns(const ObjectImage& grid, const Raster& raster) {
  const size_t count = raster.position.size();
  Columns columns;
  columns.up.assign(count, kNone);
  columns.above.assign(count, 0);
  columns.below.assign(count, 0);
  for (size_t i = 0; i < count; ++i) {
    const int32_t p = raster.position[i];
    if (p >> 16 == 0) continue;
    const int above = ((p >> 16) - 1) * grid.width + (p & 0xffff);
    const int32_t up = raster.index[static_cast<size_t>(above)];
    if (up == kNone) continue;
    if (!SameSurface(DepthAt(grid, p), DepthAt(grid, raster.position[static_cast<size_t>(up)])))
      continue;
    columns.up[i] = up;
    columns.above[i] = static_cast<uint16_t>(columns.above[static_cast<size_t>(up)] + 1);
  }
  for (size_t i = count; i-- > 0;) {
    if (columns.up[i] == kNone) continue;
    columns.below[static_cast<size_t>(columns.up[i])] = static_cast<uint16_t>(columns.below[i] + 1);
  }
  return columns;
}

// Samples in as many rows as must be held at once: a window, the row above it and the newest.
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
        grid_(masses.sparse->grid),
        radius_(radius),
        raster_(RasterOf(*masses.sparse)),
        columns_(LinkColumns(grid_, raster_)),
        ring_(MostHeld(raster_.row_begin, radius), masses.stride),
        sum_(static_cast<size_t>(grid_.width + 1) * masses.stride),
        row_label_(static_cast<size_t>(grid_.width)) {
    const size_t samples = masses.sparse->position.size();
    result_.stride = masses.stride;
    result_.mass.resize(samples * masses.stride);
    result_.label.resize(samples);
  }

  SmoothMasses Run() {
    for (int y = 0; y < grid_.height + radius_; ++y) {
      if (y < grid_.height) AverageRow(static_cast<size_t>(y));
      if (y >= radius_) ConcludeRow(static_cast<size_t>(y - radius_));
    }
    ConcludeLoners();
    return std::move(result_);
  }

 private:
  // Runs of a row end where the object does or the depth jumps.
  void AverageRow(size_t y) {
    const auto& position = raster_.position;
    for (size_t begin = raster_.row_begin[y], end; begin < raster_.row_begin[y + 1]; begin = end) {
      int depth_mm = DepthAt(grid_, position[begin]);
      for (end = begin + 1; end < raster_.row_begin[y + 1]; ++end) {
        if (position[end] != position[end - 1] + 1) break;
        const int next_mm = DepthAt(grid_, position[end]);
        if (!SameSurface(next_mm, depth_mm)) break;
        depth_mm = next_mm;
      }
      PrefixRun(masses_.mass, std::span(raster_.sample).subspan(begin, end - begin), masses_.stride,
                sum_.data());
      AverageRun(sum_.data(), radius_, static_cast<int32_t>(begin),
                 std::span(columns_.up).subspan(begin, end - begin), &ring_);
    }
  }

  void ConcludeRow(size_t y) {
    const size_t begin = raster_.row_begin[y];
    high_low_.clear();
    for (size_t i = begin; i < raster_.row_begin[y + 1]; ++i) {
      const int32_t p = raster_.position[i];
      const int at = (p >> 16) * grid_.width + (p & 0xffff);
      const int down = std::min<int>(radius_, columns_.below[i]);
      const int32_t high = raster_.index[static_cast<size_t>(at + down * grid_.width)];
      const bool goes_on = columns_.above[i] > radius_;
      high_low_.push_back(
          {high,
           goes_on ? raster_.index[static_cast<size_t>(at - (radius_ + 1) * grid_.width)] : kNone});
    }
    // The sums along the row are done with: their place serves.
    Conclude(ring_, high_low_, sum_.data(), row_label_.data());
    for (size_t k = 0; k < high_low_.size(); ++k) {
      const auto sample = static_cast<size_t>(raster_.sample[begin + k]);
      std::copy_n(sum_.data() + k * masses_.stride, masses_.stride,
                  result_.mass.data() + sample * masses_.stride);
      result_.label[sample] = row_label_[k];
    }
  }

  void ConcludeLoners() {
    for (size_t sample = masses_.sparse->on_grid; sample < result_.label.size(); ++sample) {
      uint16_t* to = result_.mass.data() + sample * masses_.stride;
      for (size_t c = 0; c < masses_.stride; ++c) {
        to[c] = static_cast<uint16_t>(4 * masses_.mass[sample * masses_.stride + c]);
      }
      result_.label[sample] = LabelOf(to, masses_.stride);
    }
  }

  const MassImage& masses_;
  const ObjectImage& grid_;
  int radius_;
  Raster raster_;
  Columns columns_;
  Ring ring_;                                     // sums down the columns, modulo 2^16
  std::vector<uint16_t> sum_;                     // along a run
  std::vector<std::array<int32_t, 2>> high_low_;  // of a row: the ends of each sample's window
  std::vector<uint8_t> row_label_;
  SmoothMasses result_;
};

}  // namespace

SmoothMasses Smooth(const MassImage& masses, int radius) {
  return Smoother(masses, std::clamp(radius, 0, kMaxSmoothRadius)).Run();
}

}  // namespace ossa::forest
