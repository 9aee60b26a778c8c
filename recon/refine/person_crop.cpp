#include "recon/refine/person_crop.h"

#include <algorithm>
#include <cmath>

namespace ossa::recon {
namespace {

// Constants: chosen by hand; part of every pose network.

constexpr double kNearer_m = 0.03;   // by so much, something that is not the person is before them
constexpr double kNearest_m = 0.2;   // what is nearer is beside the sensor
constexpr int kMiddlePixels = 4096;  // at least, where there are: more of them change nothing
constexpr int kTapsASide = 2;
static_assert(kTapsASide * kTapsASide == kCropTaps);

// The mean of the person's surface; nothing without any.
std::optional<Eigen::Vector3d> FindMiddle(const depth::DepthFrame& frame,
                                          std::span<const uint8_t> is_person) {
  const depth::DepthView view = frame.view();
  const auto count =
      static_cast<int64_t>(std::ranges::count_if(is_person, [](uint8_t of) { return of != 0; }));
  const int64_t step = std::max<int64_t>(1, count / kMiddlePixels);
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  int64_t seen = 0, read = 0;
  for (size_t p = 0; p < is_person.size(); ++p) {
    if (is_person[p] == 0 || seen++ % step != 0) continue;
    const auto pixel = static_cast<int>(p);
    if (view.at(pixel) == 0) continue;
    sum_m +=
        depth::BackProject(frame.camera, pixel % view.width, pixel / view.width, view.at(pixel));
    ++read;
  }
  if (read == 0) return std::nullopt;
  return sum_m / static_cast<double>(read);
}

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
  const depth::DepthView view = frame.view();
  const depth::Camera& camera = frame.camera;
  const Eigen::Vector3d right = out.frame_from_camera.row(0), up = out.frame_from_camera.row(1);
  const double range_m = middle_m->norm();
  constexpr double kTap_m = kCropCell_m / kTapsASide;
  constexpr double kFirst_m = (kCropSide * kTapsASide - 1) / 2.0 * kTap_m;
  for (int cell = 0; cell < kCropCells; ++cell) {
    double behind_m = 0.0;
    int surface = 0, hidden = 0;
    for (int tap = 0; tap < kCropTaps; ++tap) {
      const int column = cell % kCropSide * kTapsASide + tap % kTapsASide;
      const int row = cell / kCropSide * kTapsASide + tap / kTapsASide;
      const Eigen::Vector3d at_m =
          *middle_m + (kFirst_m - column * kTap_m) * right + (kFirst_m - row * kTap_m) * up;
      if (at_m.z() < kNearest_m) {
        ++hidden;
        continue;
      }
      const Eigen::Vector2d pixel = depth::Project(camera, at_m);
      const double u = std::floor(pixel.x() + 0.5), v = std::floor(pixel.y() + 0.5);
      if (!(u >= 0.0 && u < view.width && v >= 0.0 && v < view.height)) {
        ++hidden;
        continue;
      }
      const int index = static_cast<int>(v) * view.width + static_cast<int>(u);
      const uint16_t depth_mm = view.at(index);
      if (depth_mm == 0) continue;
      const double beyond_m = range_m * (depth::MetresFromMillimetres(depth_mm) / at_m.z() - 1.0);
      if (is_person[static_cast<size_t>(index)] != 0) {
        behind_m += std::clamp(beyond_m, -kCropReach_m, kCropReach_m);
        ++surface;
      } else if (beyond_m < -kNearer_m) {
        ++hidden;
      }
    }
    Cell& of = out.cells[static_cast<size_t>(cell)];
    if (surface > 0) of.behind_mm = static_cast<int16_t>(std::lround(1e3 * behind_m / surface));
    of.surface = static_cast<uint8_t>(surface);
    of.hidden = static_cast<uint8_t>(hidden);
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
