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
// Readings among the eight neighbours of a single-pixel hole. Borders of shadows have fewer.
constexpr int kAroundSingle = 6;  // pixels
// Share of single-pixel holes from which a sensor counts as scattering them. Real images of Kinect
// v1, Xtion and RealSense have at most 0.4 %, rendered ones of a Kinect v1 1.3; at 5 % joints moved
// by 1 cm.
constexpr double kScattered = 0.02;  // share, ours
// Neighbours with a reading needed to fill a hole: half of them. With three silhouettes grow; with
// five an image with a third of its pixels missing would not be filled.
constexpr int kFillFrom = 4;  // pixels
// The same for all fillable holes, because a grid of missing rows and columns has no single ones.
// Real images have at most 1.5 %, rendered ones of a person cut out 7 %.
constexpr double kRiddled = 0.1;  // share, ours
// A second pass fills what the first leaves where two or three holes touch.
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

// With 16-bit counters per row: the compiler processes 16 pixels at once.
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

// Samples about a sixtieth of the rows. The step is odd, so that it meets missing even or odd rows.
int RowStep(int height) { return height / 64 | 1; }

bool HasScatteredHoles(const DepthView& view) {
  HoleCount count;
  for (int v = 1; v + 1 < view.height; v += RowStep(view.height)) {
    const uint16_t* const row = view.data_mm + static_cast<ptrdiff_t>(v) * view.stride;
    CountHoles(row - view.stride, row, row + view.stride, view.width, count);
  }
  return count.is_scattered();
}

// The image with a border without readings, one pixel wide.
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

// Sorts ascending by the smallest sorting network for eight (Knuth, The Art of Computer Programming
// 3, 5.3.4): branch-free, so that the compiler vectorises over pixels.
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

// Median of the non-zero pixels; the lower of the two middle ones, so that it is an actual reading.
// 0 for fewer than kFillFrom.
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
