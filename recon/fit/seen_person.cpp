#include <algorithm>
#include <cmath>

#include "recon/body/parts.h"
#include "recon/fit/seen_person_internal.h"

namespace ossa::recon {
namespace {

// Constants: chosen by hand.

constexpr int kMostCells = 96;        // grid size at most: cells are narrower than limbs
constexpr double kNearest_m = 0.1;    // points nearer than this are not looked up
constexpr double kOccluder_m = 0.05;  // a surface up to this far behind a point may occlude it

// Calls `use` with column and row of each pixel; divides only once per row, because a person near
// the camera has tens of thousands of pixels.
template <typename Use>
void ForEachPixel(std::span<const int32_t> pixels, int32_t width, const Use& use) {
  int32_t v = 0, row_begin = 0;
  for (const int32_t pixel : pixels) {
    if (pixel < row_begin || pixel - row_begin >= width) {
      v = pixel / width;
      row_begin = v * width;
    }
    use(pixel - row_begin, v);
  }
}

}  // namespace

void SeenPerson::Look(const SurfaceFitInput& input, const SurfaceFitOptions& options) {
  frame_ = input.depth;
  TakePixels(input, options);
  MakeSilhouette(input);
}

// Subsamples the pixels with one stride in rows and columns.
void SeenPerson::TakePixels(const SurfaceFitInput& input, const SurfaceFitOptions& options) {
  pixels_.clear();
  const depth::Camera& camera = input.depth->camera;
  const bool labelled = !input.samples.empty();
  const std::span<const int32_t> from = labelled ? input.samples : input.pixels;
  size_t thin = 1;
  while (from.size() / (thin * thin) > options.most_pixels) ++thin;
  const int step = static_cast<int>(thin) * (labelled ? input.sample_step : 1);
  for (size_t i = 0; i < from.size(); ++i) {
    const int32_t pixel = from[i];
    const int u = pixel % camera.width, v = pixel / camera.width;
    const uint16_t depth_mm = input.depth->view().at(pixel);
    const uint8_t part = labelled ? input.parts[i] : uint8_t{0};
    if (u % step != 0 || v % step != 0 || depth_mm == 0 || part > kPartCount) continue;
    const Eigen::Vector3d at_m = depth::BackProject(camera, u, v, depth_mm);
    const double size_m = options.footprint * at_m.z() / camera.fx;
    pixels_.push_back({at_m, part, 1.0 / (options.pixel_m * options.pixel_m + size_m * size_m)});
  }
  const auto most = static_cast<double>(options.most_pixels);
  pixel_share_ = std::min(1.0, most / std::max(1.0, static_cast<double>(pixels_.size())));
}

void SeenPerson::MakeSilhouette(const SurfaceFitInput& input) {
  const depth::Camera& camera = input.depth->camera;
  int left = camera.width, right = 0, top = camera.height, bottom = 0;
  ForEachPixel(input.pixels, camera.width, [&](int u, int v) {
    left = std::min(left, u), right = std::max(right, u);
    top = std::min(top, v), bottom = std::max(bottom, v);
  });
  const int margin = 2 + (right - left + bottom - top) / 8;
  left_ = left - margin, top_ = top - margin;
  right += margin, bottom += margin;
  cell_px_ = std::max(1, std::max(right - left_, bottom - top_) / kMostCells);
  width_ = (right - left_) / cell_px_ + 1;
  height_ = (bottom - top_) / cell_px_ + 1;
  nearest_.assign(stride() * (static_cast<size_t>(height_) + 2), Cell{});
  column_cell_.resize(static_cast<size_t>(camera.width));
  for (int u = left; u < camera.width; ++u) {
    column_cell_[static_cast<size_t>(u)] = static_cast<int16_t>((u - left_) / cell_px_);
  }
  int row = -1;
  int16_t y = 0;
  ForEachPixel(input.pixels, camera.width, [&](int u, int v) {
    if (v != row) row = v, y = static_cast<int16_t>((v - top_) / cell_px_);
    const int16_t x = column_cell_[static_cast<size_t>(u)];
    CellAt(x, y) = {x, y};
  });
  FindNearest();
}

// Propagates nearest cells along row `y` in sweep direction, and from the three neighbours in
// `from_y` if that is the row before it.
template <bool kFromAnother>
void SeenPerson::SweepRow(int y, int from_y, bool rightwards) {
  const int step = rightwards ? 1 : -1, first = rightwards ? 0 : width_ - 1;
  const Cell* from = &CellAt(first, from_y);
  Cell* mine = &CellAt(first, y);
  for (int x = first; x >= 0 && x < width_; x += step, from += step, mine += step) {
    Cell nearest = *mine;
    const auto distance2 = [&](Cell cell) {
      return (cell.x - x) * (cell.x - x) + (cell.y - y) * (cell.y - y);
    };
    int least = distance2(nearest);
    const auto consider = [&](Cell offered) {
      const int distance = distance2(offered);
      nearest = distance < least ? offered : nearest;
      least = std::min(least, distance);
    };
    consider(mine[-step]);
    if constexpr (kFromAnother) {
      for (const int dx : {-1, 0, 1}) consider(from[dx]);
    }
    *mine = nearest;
  }
}

// Danielsson 1980, "Euclidean distance mapping": two sweeps propagate the nearest person cell to
// neighbours.
void SeenPerson::FindNearest() {
  for (int y = 0; y < height_; ++y) {
    SweepRow<true>(y, y - 1, true);
    SweepRow<false>(y, y, false);
  }
  for (int y = height_ - 1; y >= 0; --y) {
    SweepRow<true>(y, y + 1, false);
    SweepRow<false>(y, y, true);
  }
}

SeenPerson::SightAt SeenPerson::At(const Eigen::Vector3d& place_m) const {
  SightAt at;
  if (!(place_m.z() > kNearest_m)) return at;
  const depth::Camera& camera = frame_->camera;
  const Eigen::Vector2d px = depth::Project(camera, place_m);
  if (!(px.x() > 0.0 && px.y() > 0.0 && px.x() < camera.width - 1 && px.y() < camera.height - 1)) {
    return at;
  }
  const int u = static_cast<int>(std::lround(px.x())), v = static_cast<int>(std::lround(px.y()));
  if (u < left_ || v < top_) return at;
  const int x = (u - left_) / cell_px_, y = (v - top_) / cell_px_;
  if (x >= width_ || y >= height_) return at;
  const Cell nearest = CellAt(x, y);
  if (nearest.x == kNowhere) return at;
  const uint16_t depth_mm = frame_->view().at(u, v);
  at.behind_m = depth::MetresFromMillimetres(depth_mm) - place_m.z();
  if (nearest.x == x && nearest.y == y) {
    if (depth_mm != 0) at.sight = Sight::kPerson;
    return at;
  }
  if (depth_mm != 0 && at.behind_m < kOccluder_m) {
    at.sight = Sight::kHidden;
    return at;
  }
  at.sight = depth_mm == 0 ? Sight::kNoReading : Sight::kBeside;
  const double middle_px = 0.5 * (cell_px_ - 1);
  const double to_u = left_ + nearest.x * cell_px_ + middle_px;
  const double to_v = top_ + nearest.y * cell_px_ + middle_px;
  at.way_m = place_m.z() * Eigen::Vector3d((u - to_u) / camera.fx, (v - to_v) / camera.fy, 0.0);
  return at;
}

}  // namespace ossa::recon
