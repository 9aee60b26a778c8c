#include "tools/people/reidentify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ossa::people {
namespace {

using Eigen::Vector2d;

// Of a place `off` the expected one, a normal distribution over the floor.
double ComputeNormalDensity_per_m2(const Vector2d& off_m, double spread_m) {
  const double variance = spread_m * spread_m;
  return std::exp(-0.5 * off_m.squaredNorm() / variance) / (2 * std::numbers::pi * variance);
}

// Some of those out of view walk on, less and less straight; some stay; some go anywhere that can
// be reached on foot.
double ComputePlaceDensity_per_m2(const PointGrid& grid, const Track& lost,
                                  const Eigen::Vector3f& place_m, double time_s,
                                  const ReidentifyOptions& options) {
  const double gone_s = std::max(0.0, time_s - lost.last_seen_s);
  const double walked_s = options.walk_s * (1 - std::exp(-gone_s / options.walk_s));
  const Vector2d from_m = grid.OnFloor(place_m - lost.mean_m).cast<double>();
  const Vector2d walked_m = from_m - walked_s * grid.OnFloor(lost.velocity_m_s).cast<double>();
  const double rough_m_s = options.rough_m_s / std::max(1, lost.velocity_frames);
  return options.walk_share *
             ComputeNormalDensity_per_m2(walked_m,
                                         options.walk_m + (options.walk_m_s + rough_m_s) * gone_s) +
         options.stay_share *
             ComputeNormalDensity_per_m2(from_m, options.stay_m + options.stay_m_s * gone_s) +
         (1 - options.walk_share - options.stay_share) *
             ComputeNormalDensity_per_m2(from_m, options.any_m + options.any_m_s * gone_s);
}

double ExpectNewPeople_per_m2(Entrance entrance, const ReidentifyOptions& options) {
  switch (entrance) {
    case Entrance::kBehind:
      return options.new_occluded_per_m2;
    case Entrance::kBorder:
      return options.new_border_per_m2;
    case Entrance::kOpen:
      break;
  }
  return options.new_open_per_m2;
}

}  // namespace

Entrance FindEntrance(const PointGrid& grid, const std::vector<int>& cells,
                      const std::vector<float>& z_m, const std::vector<int>& person_of, int self,
                      const ReidentifyOptions& options) {
  bool behind = false;
  for (size_t k = 0; k < cells.size(); ++k) {
    const int reach = static_cast<int>(std::lround(grid.CellsOf(options.border_m, z_m[k])));
    const int x = cells[k] % grid.width, row = cells[k] - x;
    if (x < reach || x >= grid.width - reach) return Entrance::kBorder;
    for (int i = row + x - reach; i <= row + x + reach && !behind; ++i) {
      const int other = person_of[static_cast<size_t>(i)];
      behind = other >= 0 && other != self && grid.z(i) < z_m[k] - options.occluder_m;
    }
  }
  return behind ? Entrance::kBehind : Entrance::kOpen;
}

double CompareWithLost(const PointGrid& grid, const Track& lost, const Eigen::Vector3f& place_m,
                       const FrameMeasures& measures, Entrance entrance, double time_s,
                       const ReidentifyOptions& options) {
  double density = ComputePlaceDensity_per_m2(grid, lost, place_m, time_s, options);
  const bool from_behind = entrance == Entrance::kBehind;
  if (lost.lost_behind != from_behind) density *= options.other_way;
  return std::log(density / ExpectNewPeople_per_m2(entrance, options)) +
         CompareMeasures(lost.measures, measures, from_behind, options.measures);
}

std::vector<int> FindBestAssignment(const std::vector<std::vector<double>>& weight,
                                    size_t columns) {
  // Kuhn 1955 with potentials, one row after the other by a shortest augmenting path; as many
  // columns of weight 0 as there are rows stand for "none". Row and column 0 are the root's.
  const size_t rows = weight.size(), width = columns + rows;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const auto cost = [&](size_t row, size_t column) {
    return column <= columns ? -std::max(0.0, weight[row - 1][column - 1]) : 0.0;
  };
  std::vector<double> row_potential(rows + 1, 0), column_potential(width + 1, 0);
  std::vector<size_t> row_of(width + 1, 0), way(width + 1, 0);
  for (size_t row = 1; row <= rows; ++row) {
    std::vector<double> shortest(width + 1, kFar);
    std::vector<uint8_t> done(width + 1, 0);
    size_t column = 0;
    row_of[0] = row;
    while (row_of[column] != 0) {
      done[column] = 1;
      const size_t at = row_of[column];
      size_t next = 0;
      double step = kFar;
      for (size_t c = 1; c <= width; ++c) {
        if (done[c]) continue;
        const double reduced = cost(at, c) - row_potential[at] - column_potential[c];
        if (reduced < shortest[c]) shortest[c] = reduced, way[c] = column;
        if (shortest[c] < step) step = shortest[c], next = c;
      }
      for (size_t c = 0; c <= width; ++c) {
        if (done[c]) {
          row_potential[row_of[c]] += step;
          column_potential[c] -= step;
        } else {
          shortest[c] -= step;
        }
      }
      column = next;
    }
    for (; column != 0; column = way[column]) row_of[column] = row_of[way[column]];
  }
  std::vector<int> column_of(rows, -1);
  for (size_t c = 1; c <= columns; ++c) {
    const size_t row = row_of[c];
    if (row != 0 && weight[row - 1][c - 1] > 0) column_of[row - 1] = static_cast<int>(c) - 1;
  }
  return column_of;
}

}  // namespace ossa::people
