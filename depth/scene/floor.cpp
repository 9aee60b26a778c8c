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

// How far a measurement of the plane may lie off it: depth errors run along the line of sight, and
// a floor is seen at a grazing angle.
float Tolerance(const Vector4f& plane, const Vector3f& p) {
  const float along = std::abs(plane.head<3>().dot(p)) / p.norm();
  return kLeastTolerance_m + along * DepthTolerance(p.z());
}

// No tolerance there is larger, whatever the plane: that of looking straight at it. It spares most
// points the root above.
float MostTolerance(const Vector3f& p) {
  constexpr float kMostAlong = 1.001F;  // times the tolerance: 1, and what rounding may add
  return kLeastTolerance_m + kMostAlong * DepthTolerance(p.z());
}

bool OnPlane(const Vector4f& plane, const Vector3f& p) {
  const float off_m = std::abs(Height(plane, p));
  return off_m < MostTolerance(p) && off_m < Tolerance(plane, p);
}

struct Fit {
  Vector4f plane = Vector4f::Zero();
  int inliers = 0;
  int below = 0;
};

Fit Score(const std::vector<Vector3f>& points, const Vector4f& plane) {
  Fit fit{plane, 0, 0};
  for (const Vector3f& p : points) {
    const float height = Height(plane, p);
    if (height > MostTolerance(p)) continue;
    const float tolerance = Tolerance(plane, p);
    fit.inliers += std::abs(height) < tolerance ? 1 : 0;
    fit.below += height < -2 * tolerance ? 1 : 0;
  }
  return fit;
}

bool Allowed(const Vector4f& plane, const FloorOptions& options) {
  return plane[1] > std::cos(options.max_tilt_rad) &&
         plane[3] > static_cast<float>(options.min_height_m) &&
         plane[3] < static_cast<float>(options.max_height_m);
}

std::optional<Vector4f> PlaneThrough(const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  Vector3f normal = (b - a).cross(c - a);
  if (normal.norm() < 1e-3F) return std::nullopt;
  normal.normalize();
  if (normal.y() < 0) normal = -normal;
  return Vector4f(normal.x(), normal.y(), normal.z(), -normal.dot(a));
}

// Least squares through the inliers: the normal is the direction of least spread.
Vector4f Refine(const std::vector<Vector3f>& points, const Vector4f& plane) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> inliers;
  for (const Vector3f& p : points) {
    if (!OnPlane(plane, p)) continue;
    inliers.push_back(p.cast<double>());
    mean += inliers.back();
  }
  if (inliers.size() < 10) return plane;
  mean /= static_cast<double>(inliers.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : inliers) scatter += (p - mean) * (p - mean).transpose();
  Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  if (normal.y() < 0) normal = -normal;
  return Eigen::Vector4d(normal.x(), normal.y(), normal.z(), -normal.dot(mean)).cast<float>();
}

// Whether something was measured in enough squares of 10 cm of the plane.
bool IsVisible(const std::vector<Vector3f>& points, const Vector4f& plane, double min_area_m2) {
  std::set<std::pair<int, int>> squares;
  for (const Vector3f& p : points) {
    if (!OnPlane(plane, p)) continue;
    squares.insert(
        {static_cast<int>(std::floor(10 * p.x())), static_cast<int>(std::floor(10 * p.z()))});
    if (0.01 * static_cast<double>(squares.size()) >= min_area_m2) return true;
  }
  return min_area_m2 <= 0;
}

Fit Search(const std::vector<Vector3f>& low, const std::vector<Vector3f>& sample,
           const FloorOptions& options) {
  constexpr int kTrials = 200;  // floors that fill a fifth of the sample: missed once in 5
                                // (1 - 0.2^3)^200; the next frames find them
  std::mt19937_64 random(options.seed);
  Fit best;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return low[random() % low.size()]; };
    const auto plane = PlaneThrough(pick(), pick(), pick());
    if (!plane || !Allowed(*plane, options)) continue;
    const Fit fit = Score(sample, *plane);
    if (fit.below > static_cast<int>(options.max_share_below * static_cast<double>(sample.size())))
      continue;
    if (fit.inliers > best.inliers) best = fit;
  }
  return best;
}

std::optional<FloorPlane> Confirmed(const std::vector<Vector3f>& points, Vector4f plane,
                                    const FloorOptions& options) {
  plane = Refine(points, Refine(points, plane));
  if (!Allowed(plane, options)) return std::nullopt;
  const Fit fit = Score(points, plane);
  if (fit.below > options.max_share_below * static_cast<double>(points.size())) return std::nullopt;
  if (!IsVisible(points, plane, options.min_area_m2)) return std::nullopt;
  return FloorPlane{plane.cast<double>()};
}

}  // namespace

double FloorPlane::TiltDown_rad() const { return std::atan2(-coefficients[2], coefficients[1]); }

std::optional<FloorPlane> FindFloor(const PointGrid& grid, FloorState& state,
                                    const FloorOptions& options) {
  std::vector<Vector3f> points, low;
  for (int y = 0; y < grid.height; y += 2) {
    for (int x = y / 2 % 2; x < grid.width; x += 2) {
      const int cell = grid.cell(x, y);
      if (!grid.valid(cell)) continue;
      points.push_back(grid.at(cell));
      if (y > grid.height / 3) low.push_back(grid.at(cell));
    }
  }
  std::optional<FloorPlane> found;
  if (low.size() >= 50) {
    if (state.plane) found = Confirmed(points, state.plane->coefficients.cast<float>(), options);
    if (!found) {
      std::vector<Vector3f> sample;
      for (size_t i = 0; i < points.size(); i += 4) sample.push_back(points[i]);
      const Fit best = Search(low, sample, options);
      if (best.inliers > 0) found = Confirmed(points, best.plane, options);
    }
  }
  if (!found) {
    if (++state.missed > 15) state.plane.reset();  // half a second: the sensor may have moved
    return std::nullopt;
  }
  if (state.plane && state.missed == 0) {
    Eigen::Vector4d mixed = (1 - options.smoothing) * state.plane->coefficients +
                            options.smoothing * found->coefficients;
    const bool jumped = (state.plane->coefficients - found->coefficients).norm() > 0.15;
    found->coefficients = jumped ? found->coefficients : mixed / mixed.head<3>().norm();
  }
  state.plane = found;
  state.missed = 0;
  return found;
}

}  // namespace ossa::depth
