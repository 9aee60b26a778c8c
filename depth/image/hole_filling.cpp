#include "depth/image/hole_filling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "depth/image/image.h"

namespace ossa::depth {
namespace {

// Constants: chosen by hand, on real and rendered images.
//
// Of the eight neighbours of a hole that is a single pixel's. A shadow's border has fewer readings.
constexpr int kAroundSingle = 6;  // pixels
// Single-pixel holes, as a share of the readings, from which on a sensor is said to scatter them.
// Real images of Kinect v1, Xtion and RealSense have 0.4 % at most, rendered ones of a Kinect
// v1 1.3; at 5 % joints moved by 1 cm.
constexpr double kScattered = 0.02;  // share, ours
// Neighbours with a reading that a hole is filled from: half of them. With three silhouettes grow,
// with five a third of the pixels may not be missing.
constexpr int kFillFrom = 4;  // pixels
// The same of all holes that could be filled, for a grid of missing rows and columns has no single
// ones. Real images have 1.5 % at most, rendered ones of a person cut out 7 %.
constexpr double kRiddled = 0.1;  // share, ours
// What one pass leaves where two or three holes touch is filled by the second.
constexpr int kPasses = 2;

struct HoleCount {
  int64_t single = 0;
  int64_t fillable = 0;
  int64_t readings = 0;

  bool is_scattered() const {
    const auto of_readings = static_cast<double>(readings);
    return static_cast<double>(single) > kScattered * of_readings ||
           static_cast<double>(fillable) > kRiddled * of_readings;
  }
};

// In 16 bits a row: the compiler counts 16 pixels at a time.
void CountHoles(const uint16_t* above, const uint16_t* row, const uint16_t* below, int width,
                HoleCount& count) {
  uint16_t single = 0, fillable = 0, readings = 0;
  for (int u = 1; u + 1 < width; ++u) {
    const auto read = [u](const uint16_t* in) {
      return static_cast<uint16_t>((in[u - 1] != 0) + (in[u + 1] != 0));
    };
    const auto around = static_cast<uint16_t>(read(above) + read(row) + read(below) +
                                              (above[u] != 0) + (below[u] != 0));
    const bool is_hole = row[u] == 0;
    readings = static_cast<uint16_t>(readings + !is_hole);
    single = static_cast<uint16_t>(single + (is_hole & (around >= kAroundSingle)));
    fillable = static_cast<uint16_t>(fillable + (is_hole & (around >= kFillFrom)));
  }
  count.single += single;
  count.fillable += fillable;
  count.readings += readings;
}

// Not every row: a sixtieth of them tells as much. An odd step meets missing rows of an even one.
int RowStep(int height) { return height / 64 | 1; }

bool HasScatteredHoles(const DepthView& view) {
  HoleCount count;
  for (int v = 1; v + 1 < view.height; v += RowStep(view.height)) {
    const uint16_t* const row = view.data_mm + static_cast<ptrdiff_t>(v) * view.stride;
    CountHoles(row - view.stride, row, row + view.stride, view.width, count);
  }
  return count.is_scattered();
}

// With a border of no readings, one pixel wide.
Image<uint16_t> Framed(const DepthView& view) {
  Image<uint16_t> image(view.width + 2, view.height + 2);
  for (int v = 0; v < view.height; ++v) {
    std::copy_n(view.data_mm + static_cast<ptrdiff_t>(v) * view.stride, view.width,
                &image.at(1, v + 1));
  }
  return image;
}

std::vector<uint16_t> Unframed(const Image<uint16_t>& framed) {
  const int width = framed.width - 2, height = framed.height - 2;
  std::vector<uint16_t> depth_mm(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int v = 0; v < height; ++v) {
    std::copy_n(&framed.at(1, v + 1), width, depth_mm.begin() + static_cast<ptrdiff_t>(v) * width);
  }
  return depth_mm;
}

// Ascending, by the least comparators that sort eight (Knuth, The Art of Computer Programming 3,
// 5.3.4): without branches, so that the compiler does several pixels at once.
void Sort(std::array<uint16_t, 8>& a) {
  const auto order = [&a](size_t i, size_t j) {
    const uint16_t low = std::min(a[i], a[j]);
    a[j] = std::max(a[i], a[j]);
    a[i] = low;
  };
  order(0, 2), order(1, 3), order(4, 6), order(5, 7);
  order(0, 4), order(1, 5), order(2, 6), order(3, 7);
  order(0, 1), order(2, 3), order(4, 5), order(6, 7);
  order(2, 4), order(3, 5);
  order(1, 4), order(3, 6);
  order(1, 2), order(3, 4), order(5, 6);
}

// Of the pixels that are not 0; of two in the middle the lower, so that it is a reading. 0 of fewer
// than kFillFrom.
uint16_t MedianReading(std::array<uint16_t, 8> around) {
  int count = 0;
  for (const uint16_t z_mm : around) count += z_mm != 0;
  Sort(around);  // readings last
  static_assert(kFillFrom == 4);
  const uint16_t of_many = count == 8 ? around[3] : around[4];
  return count < kFillFrom ? uint16_t{0} : count < 6 ? around[5] : of_many;
}

Image<uint16_t> FilledOnce(const Image<uint16_t>& framed) {
  Image<uint16_t> filled = framed;
  for (int v = 1; v + 1 < framed.height; ++v) {
    const uint16_t *const above = &framed.at(0, v - 1), *const row = &framed.at(0, v),
                          *const below = &framed.at(0, v + 1);
    uint16_t* const to = &filled.at(0, v);
    for (int u = 1; u + 1 < framed.width; ++u) {
      const uint16_t median = MedianReading({above[u - 1], above[u], above[u + 1], row[u - 1],
                                             row[u + 1], below[u - 1], below[u], below[u + 1]});
      to[u] = row[u] != 0 ? row[u] : median;
    }
  }
  return filled;
}

}  // namespace

std::optional<DepthFrame> FillScatteredHoles(const DepthFrame& frame) {
  if (!HasScatteredHoles(frame.view())) return std::nullopt;
  Image<uint16_t> framed = Framed(frame.view());
  for (int pass = 0; pass < kPasses; ++pass) framed = FilledOnce(framed);
  return DepthFrame{Unframed(framed), frame.camera, frame.time_s, frame.index, {}};
}

}  // namespace ossa::depth
