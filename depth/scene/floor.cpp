// Constants: where a line names no origin, set by hand while developing on rendered rooms with
// validation subjects (`ossa experiment indoor-scenes`); no sweep is recorded.
#include "depth/scene/floor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace ossa::depth {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

float Height(const Vector4f& plane, const Vector3f& p) { return plane.head<3>().dot(p) + plane[3]; }

constexpr float kLeastTolerance_m = 0.015F;

// Tolerated distance of a measurement from the plane: depth errors are along the line of sight, and
// floors are seen at grazing angles.
float Tolerance(const Vector4f& plane, const Vector3f& p) {
  const float along = std::abs(plane.head<3>().dot(p)) / p.norm();
  return kLeastTolerance_m + along * DepthTolerance(p.z());
}

// Upper bound of Tolerance for any plane: that of frontal view. It avoids the square root above for
// most points.
float MostTolerance(const Vector3f& p) {
  constexpr float kMostAlong = 1.001F;  // times the tolerance: 1, plus rounding
  return kLeastTolerance_m + kMostAlong * DepthTolerance(p.z());
}

bool OnPlane(const Vector4f& plane, const Vector3f& p) {
  const float off_m = std::abs(Height(plane, p));
  return off_m < MostTolerance(p) && off_m < Tolerance(plane, p);
}

// A measurement, and the directions of the surface from there up and down the image: unit, or zero
// where nothing is measured.
struct Measured {
  Vector3f at_m;
  Vector3f up_image, down_image;
};

// Whether the surface runs along the plane. An oblique plane between floor and wall has the edges
// of both within tolerance, and possibly more inliers than a narrow strip of floor; but neither
// surface runs along it.
bool RunsAlong(const Vector4f& plane, const Measured& p) {
  constexpr float kMostSine = 0.7F;  // by hand, of 45 degrees
  return std::abs(plane.head<3>().dot(p.up_image)) < kMostSine &&
         std::abs(plane.head<3>().dot(p.down_image)) < kMostSine;
}

struct Fit {
  Vector4f plane = Vector4f::Zero();
  int inliers = 0;
  int below = 0;
};

Fit Score(const std::vector<Measured>& points, const Vector4f& plane) {
  Fit fit{plane, 0, 0};
  for (const Measured& p : points) {
    const float height = Height(plane, p.at_m);
    if (height > MostTolerance(p.at_m)) continue;
    const float tolerance = Tolerance(plane, p.at_m);
    fit.inliers += std::abs(height) < tolerance && RunsAlong(plane, p) ? 1 : 0;
    fit.below += height < -2 * tolerance ? 1 : 0;
  }
  return fit;
}

// Whether hardly anything is below the plane: few of the points there are, and few for a surface of
// its size.
bool IsLowest(const Fit& fit, size_t points, const FloorOptions& options) {
  return fit.below <= options.max_share_below * static_cast<double>(points) &&
         fit.below <= options.max_below_per_inlier * fit.inliers;
}

bool Allowed(const Vector4f& plane, const FloorOptions& options) {
  return plane.head<3>().dot(options.up.cast<float>()) > std::cos(options.max_tilt_rad) &&
         plane[3] > static_cast<float>(options.min_height_m) &&
         plane[3] < static_cast<float>(options.max_height_m);
}

std::optional<Vector4f> PlaneThrough(const Vector3f& a, const Vector3f& b, const Vector3f& c,
                                     const Vector3f& up) {
  Vector3f normal = (b - a).cross(c - a);
  if (normal.norm() < 1e-3F) return std::nullopt;
  normal.normalize();
  if (normal.dot(up) < 0) normal = -normal;
  return Vector4f(normal.x(), normal.y(), normal.z(), -normal.dot(a));
}

// Least squares through the inliers: the normal is the direction of smallest variance.
Vector4f Refine(const std::vector<Measured>& points, const Vector4f& plane,
                const FloorOptions& options) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> inliers;
  for (const Measured& p : points) {
    if (!OnPlane(plane, p.at_m) || !RunsAlong(plane, p)) continue;
    inliers.push_back(p.at_m.cast<double>());
    mean += inliers.back();
  }
  if (inliers.size() < 10) return plane;
  mean /= static_cast<double>(inliers.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : inliers) scatter += (p - mean) * (p - mean).transpose();
  Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  if (normal.dot(options.up) < 0) normal = -normal;
  return Eigen::Vector4d(normal.x(), normal.y(), normal.z(), -normal.dot(mean)).cast<float>();
}

// Whether `up` is closer to the reverse viewing direction than to up in the image.
bool IsLookingDown(const FloorOptions& options) {
  return std::abs(options.up.z()) > std::abs(options.up.y());
}

// Whether enough 10 cm squares of the plane contain measurements.
bool IsVisible(const std::vector<Measured>& points, const Vector4f& plane,
               const FloorOptions& options) {
  const double min_area_m2 = options.min_area_m2;
  const int ahead = IsLookingDown(options) ? 1 : 2;  // the second horizontal axis, besides x
  std::set<std::pair<int, int>> squares;
  for (const Measured& p : points) {
    if (!OnPlane(plane, p.at_m) || !RunsAlong(plane, p)) continue;
    squares.insert({static_cast<int>(std::floor(10 * p.at_m.x())),
                    static_cast<int>(std::floor(10 * p.at_m[ahead]))});
    if (0.01 * static_cast<double>(squares.size()) >= min_area_m2) return true;
  }
  return min_area_m2 <= 0;
}

// `low`: sorted from the top of the image to the bottom.
Fit Search(const std::vector<Measured>& low, const std::vector<Measured>& sample,
           const FloorOptions& options) {
  constexpr int kTrials = 200;  // floors with a fifth of the sample are missed once in 5
                                // (1 - 0.2^3)^200; the next frames find them
  // Every other trial samples the lowest quarter: for a level sensor the floor is a strip at the
  // lower image border. A floor with a tenth of the sample is missed once in 700, (1 - 0.4^3)^100,
  // instead of four times in five, (1 - 0.1^3)^200.
  constexpr size_t kLowest = 4;  // by hand: one in this many
  const Vector3f up = options.up.cast<float>();
  std::mt19937_64 random(options.seed);
  Fit best;
  for (int trial = 0; trial < kTrials; ++trial) {
    const size_t from = trial % 2 == 0 ? 0 : low.size() - low.size() / kLowest;
    const auto pick = [&] { return low[from + random() % (low.size() - from)].at_m; };
    // Draws are named because the evaluation order of arguments is unspecified; this is the order
    // that g++ used.
    const Vector3f c = pick(), b = pick(), a = pick();
    const auto plane = PlaneThrough(a, b, c, up);
    if (!plane || !Allowed(*plane, options)) continue;
    const Fit fit = Score(sample, *plane);
    if (fit.inliers > best.inliers && IsLowest(fit, sample.size(), options)) best = fit;
  }
  return best;
}

std::optional<FloorPlane> Confirmed(const std::vector<Measured>& points, Vector4f plane,
                                    const FloorOptions& options) {
  plane = Refine(points, Refine(points, plane, options), options);
  if (!Allowed(plane, options)) return std::nullopt;
  if (!IsLowest(Score(points, plane), points.size(), options)) return std::nullopt;
  if (!IsVisible(points, plane, options)) return std::nullopt;
  return FloorPlane{plane.cast<double>()};
}

FloorPlane Mix(const FloorPlane& before, const FloorPlane& now, double weight) {
  const Eigen::Vector4d mixed = (1 - weight) * before.coefficients + weight * now.coefficients;
  return {mixed / mixed.head<3>().norm()};
}

// Whether the mean over the frames still is this frame's floor. If the sensor was moved it is not,
// and what is left of the floor above the mean would count as somebody's feet or as furniture.
bool FitsAsWell(const std::vector<Measured>& points, const FloorPlane& mean,
                const FloorPlane& now) {
  // Share of the points on this frame's plane. By hand: a resting sensor has 0.999 and more in
  // rendered rooms, one tilted by 5 degrees none.
  constexpr double kLeastShare = 0.9;
  const int on_mean = Score(points, mean.coefficients.cast<float>()).inliers;
  const int on_now = Score(points, now.coefficients.cast<float>()).inliers;
  return on_mean >= kLeastShare * on_now;
}

// From a cell to the one `rows` below, if measured.
Vector3f Along(const PointGrid& grid, int x, int y, int rows) {
  const int other = grid.cell(x, std::clamp(y + rows, 0, grid.height - 1));
  const Vector3f step_m = grid.at(other) - grid.at(grid.cell(x, y));
  if (!grid.valid(other) || step_m.isZero()) return Vector3f::Zero();
  return step_m.normalized();
}

// Over three cells: a single one is dominated by quantisation.
Measured Measure(const PointGrid& grid, int x, int y) {
  constexpr int kCells = 3;  // by hand
  return {grid.at(grid.cell(x, y)), Along(grid, x, y, -kCells), Along(grid, x, y, kCells)};
}

}  // namespace

FloorOptions FloorOptionsFromAbove() {
  FloorOptions options;
  options.up = -Eigen::Vector3d::UnitZ();
  options.max_tilt_rad = 0.66;
  options.min_height_m = 2.0;
  options.max_height_m = 4.3;
  return options;
}

double FloorPlane::TiltDown_rad() const { return std::atan2(-coefficients[2], coefficients[1]); }

std::optional<FloorPlane> FindFloor(const PointGrid& grid, FloorState& state,
                                    const FloorOptions& options) {
  const bool anywhere = IsLookingDown(options);  // image rows are not ordered by height
  std::vector<Measured> points, low;
  for (int y = 0; y < grid.height; y += 2) {
    for (int x = y / 2 % 2; x < grid.width; x += 2) {
      const int cell = grid.cell(x, y);
      if (!grid.valid(cell)) continue;
      points.push_back(Measure(grid, x, y));
      if (anywhere || y > grid.height / 3) low.push_back(points.back());
    }
  }
  std::optional<FloorPlane> found;
  if (low.size() >= 50) {
    if (state.plane) found = Confirmed(points, state.plane->coefficients.cast<float>(), options);
    if (!found) {
      std::vector<Measured> sample;
      for (size_t i = 0; i < points.size(); i += 4) sample.push_back(points[i]);
      const Fit best = Search(low, sample, options);
      if (best.inliers > 0) found = Confirmed(points, best.plane, options);
    }
  }
  if (!found) {
    if (++state.missed > 15) state.plane.reset();  // half a second: the sensor may have been moved
    return std::nullopt;
  }
  if (state.plane && state.missed == 0) {
    const FloorPlane mean = Mix(*state.plane, *found, options.smoothing);
    if (FitsAsWell(points, mean, *found)) found = mean;
  }
  state.plane = found;
  state.missed = 0;
  return found;
}

}  // namespace ossa::depth
