// Neighbouring pixels of a surface carry the same part, but a tree answers each by itself, and its
// errors scatter like salt and pepper: averaging P(c | I, x) over a patch of about 5 cm takes them
// out. Departure from Shotton et al. 2011, whose per-pixel answers go to mean shift directly.
// Prefix sums along rows and columns make the cost independent of the patch's size.
#include "forest/smooth_internal.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>

#include "forest/clones_internal.h"

namespace ossa::forest {
namespace {

constexpr int kGap_mm = 50;  // between neighbours: an arm before the trunk

int DepthAt(const ObjectImage& image, int32_t position) {
  return image.depth_mm[image.At(position & 0xffff, position >> 16)];
}

// sum[i] = sum[i - 1] + mass[i] along one run; sum has one row more, the first of zeros.
OSSA_CLONES void PrefixRun(const uint8_t* mass, size_t count, size_t stride, uint16_t* sum) {
  std::fill_n(sum, stride, uint16_t{0});
  for (size_t i = 0; i < count; ++i, sum += stride, mass += stride) {
    for (size_t c = 0; c < stride; ++c) sum[stride + c] = static_cast<uint16_t>(sum[c] + mass[c]);
  }
}

// Means over windows of a run, times four.
OSSA_CLONES void AverageRun(const uint16_t* sum, int count, size_t stride, int radius,
                            uint16_t* out) {
  for (int i = 0; i < count; ++i) {
    const int first = std::max(0, i - radius);
    const int last = std::min(count, i + radius + 1);
    const auto share = static_cast<uint32_t>(65535 / (last - first));
    const uint16_t* low = sum + static_cast<size_t>(first) * stride;
    const uint16_t* high = sum + static_cast<size_t>(last) * stride;
    uint16_t* to = out + static_cast<size_t>(i) * stride;
    for (size_t c = 0; c < stride; ++c) {
      const auto within = static_cast<uint16_t>(static_cast<uint16_t>(high[c] - low[c]) << 2U);
      to[c] = static_cast<uint16_t>((within * share) >> 16U);
    }
  }
}

OSSA_CLONES void AddRow(uint16_t* to, const uint16_t* from, size_t stride) {
  for (size_t c = 0; c < stride; ++c) to[c] = static_cast<uint16_t>(to[c] + from[c]);
}

OSSA_CLONES void SubtractRows(const uint16_t* high, const uint16_t* low, size_t stride,
                              uint16_t* out) {
  for (size_t c = 0; c < stride; ++c) out[c] = static_cast<uint16_t>(high[c] - low[c]);
}

using Masses = std::unique_ptr<uint16_t[]>;

Masses AverageRows(const MassImage& masses, int radius_px) {
  const size_t count = masses.position.size();
  auto averaged = std::make_unique_for_overwrite<uint16_t[]>(count * masses.stride);
  std::vector<uint16_t> sum(static_cast<size_t>(masses.image->width + 1) * masses.stride);
  for (size_t begin = 0; begin < count;) {
    size_t end = begin + 1;
    int depth_mm = DepthAt(*masses.image, masses.position[begin]);
    for (; end < count && masses.position[end] == masses.position[end - 1] + 1; ++end) {
      const int next_mm = DepthAt(*masses.image, masses.position[end]);
      if (std::abs(next_mm - depth_mm) > kGap_mm) break;
      depth_mm = next_mm;
    }
    PrefixRun(masses.mass + begin * masses.stride, end - begin, masses.stride, sum.data());
    AverageRun(sum.data(), static_cast<int>(end - begin), masses.stride, radius_px,
               averaged.get() + begin * masses.stride);
    begin = end;
  }
  return averaged;
}

// For every pixel, its neighbour above on the same surface (-1: none) and how many follow each way.
struct Columns {
  std::vector<int32_t> index;  // of box positions, -1 off the object
  std::vector<uint16_t> above, below;
};

Columns LinkColumns(const MassImage& masses) {
  const ObjectImage& image = *masses.image;
  const size_t count = masses.position.size();
  Columns columns;
  columns.index.assign(static_cast<size_t>(image.width) * static_cast<size_t>(image.height), -1);
  columns.above.assign(count, 0);
  columns.below.assign(count, 0);
  const auto width = static_cast<size_t>(image.width);
  const auto place = [&](size_t i) {
    const int32_t p = masses.position[i];
    return static_cast<size_t>(p >> 16) * width + static_cast<size_t>(p & 0xffff);
  };
  std::vector<int32_t> neighbour(count, -1);
  for (size_t i = 0; i < count; ++i) {
    const size_t at = place(i);
    columns.index[at] = static_cast<int32_t>(i);
    if (at < width || columns.index[at - width] < 0) continue;
    const int32_t up = columns.index[at - width];
    const int here_mm = DepthAt(image, masses.position[i]);
    const int there_mm = DepthAt(image, masses.position[static_cast<size_t>(up)]);
    if (std::abs(here_mm - there_mm) > kGap_mm) continue;
    neighbour[i] = up;
    columns.above[i] = static_cast<uint16_t>(columns.above[static_cast<size_t>(up)] + 1);
  }
  for (size_t i = count; i-- > 0;) {
    if (neighbour[i] < 0) continue;
    columns.below[static_cast<size_t>(neighbour[i])] = static_cast<uint16_t>(columns.below[i] + 1);
  }
  return columns;
}

}  // namespace

std::unique_ptr<uint16_t[]> SmoothMasses(const MassImage& masses, int radius_px) {
  const int radius = std::clamp(radius_px, 0, kMaxSmoothRadius_px);
  const size_t stride = masses.stride;
  const Masses sum = AverageRows(masses, radius);
  const Columns columns = LinkColumns(masses);
  const int width = masses.image->width;
  const auto row = [&](int32_t x, int32_t y) {
    return static_cast<size_t>(columns.index[static_cast<size_t>(y * width + x)]) * stride;
  };
  for (size_t i = 0; i < masses.position.size(); ++i) {  // prefix sums, modulo 2^16
    if (columns.above[i] == 0) continue;
    const int32_t p = masses.position[i];
    AddRow(sum.get() + i * stride, sum.get() + row(p & 0xffff, (p >> 16) - 1), stride);
  }
  const std::vector<uint16_t> zeros(stride, 0);
  auto out = std::make_unique_for_overwrite<uint16_t[]>(masses.position.size() * stride);
  for (size_t i = 0; i < masses.position.size(); ++i) {
    const int32_t x = masses.position[i] & 0xffff;
    const int32_t y = masses.position[i] >> 16;
    const uint16_t* high = sum.get() + row(x, y + std::min<int>(radius, columns.below[i]));
    const uint16_t* low =
        columns.above[i] > radius ? sum.get() + row(x, y - radius - 1) : zeros.data();
    SubtractRows(high, low, stride, out.get() + i * stride);
  }
  return out;
}

}  // namespace ossa::forest
