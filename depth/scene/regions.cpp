#include "depth/scene/regions.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

namespace ossa::depth {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

// A wall must be larger than any side of a person: no torso has a square metre in one plane, and
// two people side by side do not connect over as much within the tolerance.
constexpr float kWallArea_m2 = 1.1F;
constexpr float kWallPieceArea_m2 = 0.45F;

// Area of the surface itself, not of its frontal view: a patch seen at a slant is larger.
float SurfaceArea(const PointGrid& grid, int cell, const Vector4f& plane) {
  const Vector3f& p = grid.at(cell);
  const float cosine = std::abs(plane.head<3>().dot(p)) / p.norm();
  return grid.Area(cell) / std::max(cosine, 0.15F);
}

std::optional<Vector4f> LocalPlane(const PointGrid& grid, int x, int y, int reach) {
  if (!grid.Contains(x + reach, y + reach) || !grid.Contains(x - reach, y - reach))
    return std::nullopt;
  const int a = grid.cell(x - reach, y - reach), b = grid.cell(x + reach, y - reach);
  const int c = grid.cell(x, y + reach);
  if (!grid.valid(a) || !grid.valid(b) || !grid.valid(c)) return std::nullopt;
  Vector3f normal = (grid.at(b) - grid.at(a)).cross(grid.at(c) - grid.at(a));
  if (normal.norm() < 1e-6F) return std::nullopt;
  normal.normalize();
  return Vector4f(normal.x(), normal.y(), normal.z(), -normal.dot(grid.at(a)));
}

bool OnPlane(const Vector3f& p, const Vector4f& plane) {
  return std::abs(plane.head<3>().dot(p) + plane[3]) < DepthTolerance(p.z());
}

float PlaneArea(const PointGrid& grid, const std::vector<int>& sample, const Vector4f& plane,
                int thinning) {
  float area = 0;
  for (const int cell : sample) {
    if (OnPlane(grid.at(cell), plane)) area += SurfaceArea(grid, cell, plane);
  }
  return area * static_cast<float>(thinning);
}

// Marks the connected pieces of the plane that are large themselves; people who stand in the same
// plane as a wall's end are pieces of their own and stay.
bool MarkPlane(const PointGrid& grid, const Vector4f& plane, std::vector<uint8_t>& room) {
  std::vector<uint8_t> ignore(room.size(), 1);
  for (int i = 0; i < grid.cells(); ++i) {
    const auto n = static_cast<size_t>(i);
    if (!room[n] && grid.valid(i) && OnPlane(grid.at(i), plane)) ignore[n] = 0;
  }
  bool marked = false;
  for (const Region& piece : ConnectedRegions(grid, ignore, 0.02F)) {
    float area = 0;
    for (const int cell : piece.cells) area += SurfaceArea(grid, cell, plane);
    if (area < kWallPieceArea_m2) continue;
    marked = true;
    for (const int cell : piece.cells) room[static_cast<size_t>(cell)] = 1;
  }
  return marked;
}

void MarkWalls(const PointGrid& grid, std::vector<uint8_t>& room) {
  constexpr int kThinning = 9, kTrials = 40, kMaxWalls = 5;
  std::mt19937_64 random(7);
  for (int wall = 0; wall < kMaxWalls; ++wall) {
    std::vector<int> sample;
    for (int y = 1; y < grid.height; y += 3) {
      for (int x = 1; x < grid.width; x += 3) {
        const int cell = grid.cell(x, y);
        if (grid.valid(cell) && !room[static_cast<size_t>(cell)]) sample.push_back(cell);
      }
    }
    if (sample.size() < 40) return;
    float best_area = 0;
    Vector4f best = Vector4f::Zero();
    for (int trial = 0; trial < kTrials; ++trial) {
      const int cell = sample[random() % sample.size()];
      const auto plane = LocalPlane(grid, cell % grid.width, cell / grid.width, trial % 2 ? 4 : 9);
      if (!plane) continue;
      const float area = PlaneArea(grid, sample, *plane, kThinning);
      if (area > best_area) best_area = area, best = *plane;
    }
    if (best_area < kWallArea_m2 || !MarkPlane(grid, best, room)) return;
  }
}

}  // namespace

std::vector<uint8_t> RoomSurfaces(const PointGrid& grid, const std::optional<FloorPlane>& floor) {
  std::vector<uint8_t> room(static_cast<size_t>(grid.cells()), 0);
  if (floor) {
    for (int i = 0; i < grid.cells(); ++i) {
      if (!grid.valid(i)) continue;
      const double height = floor->HeightOf(grid.at(i).cast<double>());
      room[static_cast<size_t>(i)] = height < 0.02 + DepthTolerance(grid.z(i));
    }
  }
  MarkWalls(grid, room);
  return room;
}

Region MakeRegion(const PointGrid& grid, std::vector<int> cells) {
  Region region;
  std::sort(cells.begin(), cells.end());
  region.cells = std::move(cells);
  region.low_m = Vector3f::Constant(1e9F);
  region.high_m = Vector3f::Constant(-1e9F);
  region.mean_m = Vector3f::Zero();
  for (const int cell : region.cells) {
    region.low_m = region.low_m.cwiseMin(grid.at(cell));
    region.high_m = region.high_m.cwiseMax(grid.at(cell));
    region.mean_m += grid.at(cell);
    region.area_m2 += grid.Area(cell);
  }
  if (!region.cells.empty()) region.mean_m /= static_cast<float>(region.cells.size());
  return region;
}

bool Continuous(const PointGrid& grid, int a, int b) {
  const float near = std::min(grid.z(a), grid.z(b));
  // A thigh or a forearm recedes by at most about 4 cm a cell; sensor steps come on top.
  return std::abs(grid.z(a) - grid.z(b)) < 0.04F + 0.5F * DepthTolerance(near);
}

std::vector<Region> ConnectedRegions(const PointGrid& grid, std::span<const uint8_t> ignore,
                                     float min_area_m2) {
  std::vector<Region> regions;
  std::vector<uint8_t> done(ignore.begin(), ignore.end());
  std::vector<int> front;
  for (int start = 0; start < grid.cells(); ++start) {
    if (done[static_cast<size_t>(start)] || !grid.valid(start)) continue;
    front.assign(1, start);
    done[static_cast<size_t>(start)] = 1;
    for (size_t i = 0; i < front.size(); ++i) {
      const int cell = front[i], x = cell % grid.width, y = cell / grid.width;
      constexpr int kSteps[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1},
                                    {2, 0}, {-2, 0}, {0, 2}, {0, -2}};
      for (const auto& step : kSteps) {
        if (!grid.Contains(x + step[0], y + step[1])) continue;
        const int next = grid.cell(x + step[0], y + step[1]);
        const auto n = static_cast<size_t>(next);
        if (done[n] || !grid.valid(next) || !Continuous(grid, cell, next)) continue;
        done[n] = 1;
        front.push_back(next);
      }
    }
    Region region = MakeRegion(grid, front);
    if (region.area_m2 >= min_area_m2) regions.push_back(std::move(region));
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.area_m2 > b.area_m2; });
  return regions;
}

}  // namespace ossa::depth
