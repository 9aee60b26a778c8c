// Constants: where a line names no origin, set by hand while developing on rendered rooms with
// validation subjects (`ossa experiment indoor-scenes`); no sweep is recorded.
#include "depth/scene/furniture_internal.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ossa::depth {
namespace {

using Eigen::Vector3d;

constexpr double kLeastTolerance_m = 0.025;

// Bounds of upright patches of one plane.
class UprightBounds {
 public:
  UprightBounds(const FloorPlane& floor, const Vector3d& along, const FurnitureOptions& options)
      : floor_(floor), along_(along), options_(options) {}

  void Add(const PointGrid& grid, const FlatPiece& piece) {
    area_m2_ += piece.area_m2;
    for (const int cell : piece.cells) {
      const Vector3d p = grid.at(cell).cast<double>();
      const double height_m = floor_.HeightOf(p), beside_m = along_.dot(p);
      low_m_ = std::min(low_m_, height_m), high_m_ = std::max(high_m_, height_m);
      left_m_ = std::min(left_m_, beside_m), right_m_ = std::max(right_m_, beside_m);
    }
  }
  bool IsLow() const { return high_m_ < options_.front_top_m; }
  bool IsFurniture() const {
    const double wide_m = right_m_ - left_m_;
    return IsLow() && low_m_ < options_.front_foot_m && wide_m > options_.front_width_m &&
           area_m2_ > options_.front_filled * wide_m * (high_m_ - low_m_);
  }

 private:
  const FloorPlane& floor_;
  Vector3d along_;
  const FurnitureOptions& options_;
  double area_m2_ = 0, low_m_ = 1e9, high_m_ = -1e9, left_m_ = 1e9, right_m_ = -1e9;
};

// Horizontal extent of a surface, from sums over its cells.
struct Spread {
  double area_m2 = 0;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void Add(const Vector3d& p, double m2) {
    area_m2 += m2;
    sum += m2 * p;
    squares += m2 * p * p.transpose();
  }
  // The shorter side of the rectangle with this variance (a twelfth of the square of the side). The
  // smallest eigenvalue is that of the height, which is constant.
  double Width_m() const {
    const Vector3d mean = sum / area_m2;
    const Eigen::Matrix3d covariance = squares / area_m2 - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(12 * std::max(0.0, solver.eigenvalues()[1]));
  }
};

// Area of a horizontal surface within a cell.
double HorizontalArea_m2(const PointGrid& grid, const Vector3d& up, int cell) {
  constexpr double kMostSlanted = 0.05;  // cosine; below, the area is undefined
  const Vector3d p = grid.at(cell).cast<double>();
  return static_cast<double>(grid.Area(cell)) /
         std::max(kMostSlanted, std::abs(up.dot(p)) / p.norm());
}

// Heights of the cells on level surfaces, 0 for others: on upright surfaces the cell above is
// higher by the cell spacing, on level ones it is equally high.
std::vector<float> LevelHeights(const PointGrid& grid, const FloorPlane& floor,
                                const std::vector<uint8_t>& room, const FurnitureOptions& options) {
  std::vector<float> height_m(static_cast<size_t>(grid.cells()), 0.0F), level_m = height_m;
  for (int i = 0; i < grid.cells(); ++i) {
    const auto n = static_cast<size_t>(i);
    if (!grid.valid(i) || room[n]) continue;
    height_m[n] = static_cast<float>(floor.HeightOf(grid.at(i).cast<double>()));
  }
  const auto level = [&](int a, int b) {
    const float pitch_m = 1.0F / grid.CellsOf(1.0F, grid.z(a));
    return height_m[static_cast<size_t>(b)] != 0 &&
           std::abs(height_m[static_cast<size_t>(a)] - height_m[static_cast<size_t>(b)]) <
               options.level * pitch_m;
  };
  for (int i = 0; i < grid.cells(); ++i) {
    const float h = height_m[static_cast<size_t>(i)];
    if (h < options.min_top_height_m || h > options.max_top_height_m) continue;
    const bool above = i >= grid.width && level(i, i - grid.width);
    const bool below = i + grid.width < grid.cells() && level(i, i + grid.width);
    if (above || below) level_m[static_cast<size_t>(i)] = h;
  }
  return level_m;
}

// Extracts the cells around `start` at one height; removes them from `level_m`.
std::vector<int> TakeTop(const PointGrid& grid, const FloorPlane& floor, int start,
                         std::vector<float>& level_m, Spread& spread) {
  std::vector<int> top(1, start);
  double mean_m = static_cast<double>(level_m[static_cast<size_t>(start)]);
  level_m[static_cast<size_t>(start)] = 0;
  for (size_t i = 0; i < top.size(); ++i) {
    const int cell = top[i], x = cell % grid.width, y = cell / grid.width;
    const Vector3d p = grid.at(cell).cast<double>();
    spread.Add(p, HorizontalArea_m2(grid, floor.coefficients.head<3>(), cell));
    mean_m += (floor.HeightOf(p) - mean_m) / static_cast<double>(i + 1);
    for (const auto& step : kStepsOverGaps) {
      if (!grid.Contains(x + step[0], y + step[1])) continue;
      const int next = grid.cell(x + step[0], y + step[1]);
      float& height_m = level_m[static_cast<size_t>(next)];
      if (height_m == 0) continue;
      const double off_m = std::abs(static_cast<double>(height_m) - mean_m);
      // The height of a table top is, unlike the floor's, the mean of its own cells: half the
      // tolerance.
      if (off_m > 0.5 * MostHeightTolerance(grid.at(next)) ||
          off_m > 0.5 * HeightTolerance(floor, grid.at(next)))
        continue;
      height_m = 0;
      top.push_back(next);
    }
  }
  return top;
}

}  // namespace

double HeightTolerance(const FloorPlane& floor, const Eigen::Vector3f& p) {
  const double along =
      std::abs(floor.coefficients.head<3>().dot(p.cast<double>())) / static_cast<double>(p.norm());
  return kLeastTolerance_m + along * static_cast<double>(DepthTolerance(p.z()));
}

double MostHeightTolerance(const Eigen::Vector3f& p) {
  constexpr double kMostAlong = 1.001;  // times the tolerance: 1, plus rounding
  return kLeastTolerance_m + kMostAlong * static_cast<double>(DepthTolerance(p.z()));
}

bool LiesInPlaneOf(const PointGrid& grid, const FlatPiece& piece, const FlatPiece& wall,
                   const FurnitureOptions& options) {
  if (piece.normal.dot(wall.normal) < options.same_normal) return false;
  double off = 0;
  for (const int cell : piece.cells) {
    off += 1.0 / static_cast<double>(grid.z(cell)) - wall.slope_x * (cell % grid.width) -
           wall.slope_y * (cell / grid.width) - wall.at_zero;
  }
  return std::abs(off) / static_cast<double>(piece.cells.size()) < options.same_depth_per_m;
}

std::vector<int> LowFront(const PointGrid& grid, const FloorPlane& floor,
                          const std::vector<FlatPiece>& pieces, const FlatPiece& piece,
                          const FurnitureOptions& options) {
  const Vector3d up = floor.coefficients.head<3>();
  if (std::abs(piece.normal.dot(up)) > options.upright_cosine) return {};
  UprightBounds bounds(floor, up.cross(piece.normal).normalized(), options);
  bounds.Add(grid, piece);
  if (!bounds.IsLow()) return {};
  std::vector<int> cells = piece.cells;
  for (const FlatPiece& other : pieces) {
    if (&other == &piece || !LiesInPlaneOf(grid, other, piece, options)) continue;
    bounds.Add(grid, other);
    cells.insert(cells.end(), other.cells.begin(), other.cells.end());
  }
  return bounds.IsFurniture() ? cells : std::vector<int>{};
}

void MarkTops(const PointGrid& grid, const FloorPlane& floor, const FurnitureOptions& options,
              std::vector<uint8_t>& room) {
  std::vector<float> level_m = LevelHeights(grid, floor, room, options);
  for (int start = 0; start < grid.cells(); ++start) {
    if (level_m[static_cast<size_t>(start)] == 0) continue;
    Spread spread;
    const std::vector<int> top = TakeTop(grid, floor, start, level_m, spread);
    if (spread.area_m2 < options.min_level_m2 || spread.Width_m() < options.min_level_width_m)
      continue;
    for (const int cell : top) room[static_cast<size_t>(cell)] = 1;
  }
}

}  // namespace ossa::depth
