// Neighbouring pixels of a surface belong to the same part, but trees classify each independently,
// with salt-and-pepper errors: averaging P(c | I, x) over a patch of about 5 cm removes them.
// Departure from Shotton et al. 2011, who feed per-pixel results to mean shift directly. Prefix
// sums along rows and columns make the cost independent of the patch size. Only the rows of one
// window are stored, so they stay in the cache.
#include "forest/classification/smoothed_masses_internal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "depth/base/cpu_dispatch.h"

namespace ossa::forest {
namespace {

// Constants: of vector registers and of 8 bits.

constexpr size_t kBlock = 16;  // masses per vector operation
constexpr int32_t kNone = SparsePixels::kNone;

// 65535 / width: replaces the division by a 16-bit multiplication.
constexpr auto kShareOfWidth = [] {
  std::array<uint16_t, 2 * kMaxSmoothRadius + 2> share{};
  for (size_t width = 1; width < share.size(); ++width) {
    share[width] = static_cast<uint16_t>(65535 / width);
  }
  return share;
}();

// Ring buffer of the mass rows of recent pixels, by pixel index.
struct Ring {
  size_t stride = 0;
  size_t capacity = 0;         // a power of two
  std::vector<uint16_t> rows;  // and one row of zeros, for missing pixels

  Ring(size_t pixels, size_t row_stride)
      : stride(row_stride), capacity(std::bit_ceil(pixels)), rows((capacity + 1) * stride) {}
  size_t At(int32_t pixel) const {
    return (pixel == kNone ? capacity : static_cast<size_t>(pixel) & (capacity - 1)) * stride;
  }
};

using Block = uint16_t __attribute__((vector_size(2 * kBlock)));
using ByteBlock = uint8_t __attribute__((vector_size(kBlock)));

// sum[i] = sum[i - 1] + mass[sample[i]] along a run; sum has one additional row of zeros at its
// start.
OSSA_CPU_DISPATCH void PrefixRun(const uint8_t* mass, std::span<const int32_t> sample,
                                 size_t stride, uint16_t* sum) {
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

// Adds the window means, times four, of a run starting at pixel `first` to the sums of the pixels
// above.
OSSA_CPU_DISPATCH void AverageRun(const uint16_t* sum, int radius, int32_t first,
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

// The first of a row's largest columns, plus 1; 0 without mass.
[[gnu::always_inline]] inline uint8_t ChooseLabel(const uint16_t* mass, size_t stride) {
  constexpr uint32_t kColumns = 255;
  uint32_t best = 0;
  for (size_t c = 0; c < stride; ++c) {
    const uint32_t key =
        static_cast<uint32_t>(mass[c]) << 8U | (kColumns - static_cast<uint32_t>(c));
    best = key > best ? key : best;
  }
  return best >> 8U == 0 ? 0 : static_cast<uint8_t>(kColumns - (best & kColumns) + 1);
}

// The last row of a sample's window, the row before its first, and the sample.
struct Window {
  int32_t high = kNone;
  int32_t low = kNone;
  int32_t sample = 0;
};

// Differences of the sums at `high` and `low`, modulo 2^16, and the label of each.
OSSA_CPU_DISPATCH void Conclude(const Ring& ring, std::span<const Window> windows, uint16_t* mass,
                                uint8_t* label) {
  const uint16_t* rows = ring.rows.data();
  const size_t stride = ring.stride;
  for (const Window& window : windows) {
    const uint16_t* minuend = rows + ring.At(window.high);
    const uint16_t* subtrahend = rows + ring.At(window.low);
    uint16_t* out = mass + static_cast<size_t>(window.sample) * stride;
    for (size_t b = 0; b < stride; b += kBlock) {
      Block high, low;
      std::memcpy(&high, minuend + b, sizeof(Block));
      std::memcpy(&low, subtrahend + b, sizeof(Block));
      high -= low;
      std::memcpy(out + b, &high, sizeof(Block));
    }
    label[window.sample] = ChooseLabel(out, stride);
  }
}

// The grid samples in raster order, by which they are indexed below.
struct Raster {
  std::vector<int32_t> cell;
  std::vector<int32_t> sample;
  std::vector<size_t> row_begin;  // index of the first of each row, and the total number
  std::vector<int32_t> index;     // per cell: its raster index; or kNone
  // The extent of each sample's column on the same surface.
  std::vector<int32_t> up;             // neighbour above; or kNone
  std::vector<uint16_t> above, below;  // number of samples in each direction
};

// The sample above one in row y, if on the same surface.
int32_t NeighbourAbove(const ObjectImage& grid, const Raster& raster, int x, int y) {
  if (y == 0) return kNone;
  const int32_t up = raster.index[static_cast<size_t>((y - 1) * grid.width + x)];
  if (up == kNone) return kNone;
  return SameSurface(grid.depth_mm[grid.At(x, y)], grid.depth_mm[grid.At(x, y - 1)]) ? up : kNone;
}

Raster MakeRaster(const SparsePixels& sparse) {
  const ObjectImage& grid = sparse.grid;
  Raster raster;
  raster.index.assign(sparse.sample.size(), kNone);
  for (auto* list : {&raster.cell, &raster.sample, &raster.up}) list->resize(sparse.on_grid);
  raster.above.assign(sparse.on_grid, 0);
  raster.below.assign(sparse.on_grid, 0);
  size_t count = 0;
  for (int y = 0, cell = 0; y < grid.height; ++y) {
    raster.row_begin.push_back(count);
    for (int x = 0; x < grid.width; ++x, ++cell) {
      const int32_t sample = sparse.sample[static_cast<size_t>(cell)];
      if (sample == kNone) continue;
      const int32_t up = NeighbourAbove(grid, raster, x, y);
      if (up != kNone) {
        raster.above[count] = static_cast<uint16_t>(raster.above[static_cast<size_t>(up)] + 1);
      }
      raster.index[static_cast<size_t>(cell)] = static_cast<int32_t>(count);
      raster.up[count] = up;
      raster.cell[count] = cell;
      raster.sample[count++] = sample;
    }
  }
  raster.row_begin.push_back(count);
  for (size_t i = count; i-- > 0;) {
    if (raster.up[i] == kNone) continue;
    raster.below[static_cast<size_t>(raster.up[i])] = static_cast<uint16_t>(raster.below[i] + 1);
  }
  return raster;
}

// Number of samples in the rows stored at once: a window, the row above it and the newest row.
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
        raster_(MakeRaster(*masses.sparse)),
        ring_(MostHeld(raster_.row_begin, radius), masses.stride),
        sum_(static_cast<size_t>(grid_.width + 1) * masses.stride) {
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
  // Runs end at the object's border and at depth discontinuities.
  void AverageRow(size_t y) {
    const uint16_t* depth_mm = &grid_.depth_mm[grid_.At(0, static_cast<int>(y))];
    const auto& cell = raster_.cell;
    const auto row_cell = static_cast<int32_t>(y) * grid_.width;
    for (size_t begin = raster_.row_begin[y], end; begin < raster_.row_begin[y + 1]; begin = end) {
      int here_mm = depth_mm[cell[begin] - row_cell];
      for (end = begin + 1; end < raster_.row_begin[y + 1]; ++end) {
        if (cell[end] != cell[end - 1] + 1) break;
        const int next_mm = depth_mm[cell[end] - row_cell];
        if (!SameSurface(next_mm, here_mm)) break;
        here_mm = next_mm;
      }
      PrefixRun(masses_.mass, std::span(raster_.sample).subspan(begin, end - begin), masses_.stride,
                sum_.data());
      AverageRun(sum_.data(), radius_, static_cast<int32_t>(begin),
                 std::span(raster_.up).subspan(begin, end - begin), &ring_);
    }
  }

  void ConcludeRow(size_t y) {
    windows_.clear();
    for (size_t i = raster_.row_begin[y]; i < raster_.row_begin[y + 1]; ++i) {
      const int32_t cell = raster_.cell[i];
      const int down = std::min<int>(radius_, raster_.below[i]);
      const bool goes_on = raster_.above[i] > radius_;
      const int32_t low =
          goes_on ? raster_.index[static_cast<size_t>(cell - (radius_ + 1) * grid_.width)] : kNone;
      windows_.push_back(
          {raster_.index[static_cast<size_t>(cell + down * grid_.width)], low, raster_.sample[i]});
    }
    Conclude(ring_, windows_, result_.mass.data(), result_.label.data());
  }

  void ConcludeLoners() {
    for (size_t sample = masses_.sparse->on_grid; sample < result_.label.size(); ++sample) {
      uint16_t* to = result_.mass.data() + sample * masses_.stride;
      for (size_t c = 0; c < masses_.stride; ++c) {
        to[c] = static_cast<uint16_t>(4 * masses_.mass[sample * masses_.stride + c]);
      }
      result_.label[sample] = ChooseLabel(to, masses_.stride);
    }
  }

  const MassImage& masses_;
  const ObjectImage& grid_;
  int radius_;
  Raster raster_;
  Ring ring_;                    // column sums, modulo 2^16
  std::vector<uint16_t> sum_;    // prefix sums of a run
  std::vector<Window> windows_;  // windows of a row
  SmoothMasses result_;
};

}  // namespace

SmoothMasses Smooth(const MassImage& masses, int radius) {
  return Smoother(masses, std::clamp(radius, 0, kMaxSmoothRadius)).Run();
}

}  // namespace ossa::forest
