#include "recon/refine/person_crop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "depth/base/cpu_dispatch.h"

namespace ossa::recon {
namespace {

// Constants: chosen by hand; part of every pose network.

constexpr double kNearer_m = 0.03;   // other surfaces nearer by this occlude the person
constexpr double kNearest_m = 0.2;   // nearer points are outside the view: beside the sensor
constexpr int kMiddlePixels = 4096;  // sample at least as many if available: more change nothing
constexpr int kTapsASide = 2;
static_assert(kTapsASide * kTapsASide == kCropTaps);

// Whether none of the eight pixels from `first` on belongs to the person.
bool AreOthers(std::span<const uint8_t> is_person, size_t first) {
  uint64_t eight = 0;
  std::memcpy(&eight, is_person.data() + first, sizeof(eight));
  return eight == 0;
}

// The mean of the person's surface; none without any.
std::optional<Eigen::Vector3d> FindMiddle(const depth::DepthFrame& frame,
                                          std::span<const uint8_t> is_person) {
  constexpr size_t kEight = sizeof(uint64_t);
  const depth::DepthView view = frame.view();
  const auto count = std::ranges::count_if(is_person, [](uint8_t of) { return of != 0; });
  const int64_t step = std::max<int64_t>(1, count / kMiddlePixels);
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  int64_t passed_over = step - 1, read = 0;
  for (size_t p = 0; p < is_person.size(); ++p) {
    if (p % kEight == 0 && p + kEight <= is_person.size() && AreOthers(is_person, p)) {
      p += kEight - 1;
      continue;
    }
    if (is_person[p] == 0 || ++passed_over < step) continue;
    passed_over = 0;
    const auto pixel = static_cast<int>(p);
    if (view.at(pixel) == 0) continue;
    sum_m +=
        depth::BackProject(frame.camera, pixel % view.width, pixel / view.width, view.at(pixel));
    ++read;
  }
  if (read == 0) return std::nullopt;
  return sum_m / static_cast<double>(read);
}

// The taps are sampling points in a plane perpendicular to the line of sight, row by row from the
// top.
constexpr int kTapSide = kCropSide * kTapsASide;
constexpr double kTap_m = kCropCell_m / kTapsASide;
constexpr double kFirstTap_m = (kTapSide - 1) / 2.0 * kTap_m;

// The part of their positions that is the same in every row, camera space.
struct TapColumns {
  std::array<double, kTapSide> x_m, y_m, z_m;

  TapColumns(const Eigen::Vector3d& middle_m, const Eigen::Vector3d& right) {
    for (int column = 0; column < kTapSide; ++column) {
      const Eigen::Vector3d at_m = middle_m + (kFirstTap_m - column * kTap_m) * right;
      const auto c = static_cast<size_t>(column);
      x_m[c] = at_m.x(), y_m[c] = at_m.y(), z_m[c] = at_m.z();
    }
  }
};

// A row of taps: the distance of each from the camera, and its pixel, -1 for none.
struct TapRow {
  std::array<double, kTapSide> z_m;
  std::array<int32_t, kTapSide> pixel;
};

// Branch-free, so that the compiler vectorises it.
OSSA_CPU_DISPATCH void FindPixels(const depth::Camera& camera, const TapColumns& columns,
                                  const Eigen::Vector3d& down_m, TapRow* row) {
  const double width = camera.width, height = camera.height;
  for (size_t c = 0; c < kTapSide; ++c) {
    const double z_m = columns.z_m[c] + down_m.z();
    const double u = camera.cx - camera.fx * (columns.x_m[c] + down_m.x()) / z_m + 0.5;
    const double v = camera.cy - camera.fy * (columns.y_m[c] + down_m.y()) / z_m + 0.5;
    const bool seen = (z_m >= kNearest_m) & (u >= 0.0) & (u < width) & (v >= 0.0) & (v < height);
    const auto of_column = static_cast<int32_t>(seen ? u : 0.0);
    const auto of_row = static_cast<int32_t>(seen ? v : 0.0);
    row->z_m[c] = z_m;
    row->pixel[c] = seen ? of_row * camera.width + of_column : -1;
  }
}

// Accumulated taps of a cell.
struct CellTally {
  double behind_m = 0.0;
  int surface = 0, hidden = 0;

  PersonCrop::Cell ToCell() const {
    PersonCrop::Cell cell;
    if (surface > 0) cell.behind_mm = static_cast<int16_t>(std::lround(1e3 * behind_m / surface));
    cell.surface = static_cast<uint8_t>(surface);
    cell.hidden = static_cast<uint8_t>(hidden);
    return cell;
  }
};

struct SeenScene {
  depth::DepthView view;
  std::span<const uint8_t> is_person;
  double range_m = 0.0;  // distance of the plane of taps

  void Read(const TapRow& row, size_t tap, CellTally* cell) const {
    const int32_t pixel = row.pixel[tap];
    if (pixel < 0) {
      ++cell->hidden;
      return;
    }
    const uint16_t depth_mm = view.at(pixel);
    if (depth_mm == 0) return;
    const double beyond_m = range_m * (depth::MetresFromMillimetres(depth_mm) / row.z_m[tap] - 1.0);
    if (is_person[static_cast<size_t>(pixel)] != 0) {
      cell->behind_m += std::clamp(beyond_m, -kCropReach_m, kCropReach_m);
      ++cell->surface;
    } else if (beyond_m < -kNearer_m) {
      ++cell->hidden;
    }
  }
};

}  // namespace

std::optional<PersonCrop> PersonCrop::Cut(const depth::DepthFrame& frame,
                                          std::span<const uint8_t> is_person) {
  const depth::Camera& size = frame.camera;
  if (is_person.size() != frame.pixel_count() || size.width <= 0 || size.height <= 0 ||
      frame.pixel_count() != static_cast<size_t>(size.width) * static_cast<size_t>(size.height)) {
    return std::nullopt;
  }
  const auto middle_m = FindMiddle(frame, is_person);
  if (!middle_m) return std::nullopt;
  const auto axes = MakeViewFrame(*middle_m);
  if (!axes) return std::nullopt;
  PersonCrop out{*axes, std::vector<Cell>(kCropCells)};
  const TapColumns columns(*middle_m, out.frame_from_camera.row(0));
  const Eigen::Vector3d up = out.frame_from_camera.row(1);
  const SeenScene scene{frame.view(), is_person, middle_m->norm()};
  std::array<TapRow, kTapsASide> rows;
  for (int cell_row = 0; cell_row < kCropSide; ++cell_row) {
    for (int down = 0; down < kTapsASide; ++down) {
      const double below_m = kFirstTap_m - (cell_row * kTapsASide + down) * kTap_m;
      FindPixels(frame.camera, columns, below_m * up, &rows[static_cast<size_t>(down)]);
    }
    for (size_t column = 0; column < kCropSide; ++column) {
      CellTally cell;
      for (const TapRow& row : rows) {
        for (size_t tap = 0; tap < kTapsASide; ++tap) {
          scene.Read(row, column * kTapsASide + tap, &cell);
        }
      }
      out.cells[static_cast<size_t>(cell_row) * kCropSide + column] = cell.ToCell();
    }
  }
  return out;
}

Eigen::Vector3d PersonCrop::Project(const Eigen::Vector3d& place_m) const {
  const double range_m = middle_m.norm();
  const Eigen::Vector3d from_m = frame_from_camera * (place_m - middle_m);
  const double nearer = range_m / (range_m + from_m.z());
  return {from_m.x() * nearer, from_m.y() * nearer, from_m.z()};
}

Eigen::Vector3d PersonCrop::BackProject(const Eigen::Vector3d& projected_m) const {
  const double range_m = middle_m.norm();
  const double farther = (range_m + projected_m.z()) / range_m;
  const Eigen::Vector3d from_m(projected_m.x() * farther, projected_m.y() * farther,
                               projected_m.z());
  return middle_m + frame_from_camera.transpose() * from_m;
}

}  // namespace ossa::recon
