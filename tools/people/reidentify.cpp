#include "tools/people/reidentify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ossa::people {
namespace {

using Eigen::Vector2d;

// Density of an isotropic normal distribution over the floor.
double ComputeNormalDensity_per_m2(const Vector2d& off_m, double spread_m) {
  const double variance = spread_m * spread_m;
  return std::exp(-0.5 * off_m.squaredNorm() / variance) / (2 * std::numbers::pi * variance);
}

// A mixture: the lost person walks on, less and less straight; stays; or goes anywhere within
// walking distance.
double ComputePlaceDensity_per_m2(const PointGrid& grid, const Track& lost,
                                  const Eigen::Vector3f& place_m, double time_s,
                                  const ReidentifyOptions& options) {
  const double gone_s = std::max(0.0, time_s - lost.last_seen_s);
  const double walked_s = options.walk_s * (1 - std::exp(-gone_s / options.walk_s));
  const Vector2d from_m = grid.OnFloor(place_m - lost.mean_m).cast<double>();
  const Vector2d walked_m = from_m - walked_s * grid.OnFloor(lost.velocity_m_s).cast<double>();
  const double velocity_noise_m_s = options.velocity_noise_m_s / std::max(1, lost.velocity_frames);
  return options.walk_share *
             ComputeNormalDensity_per_m2(
                 walked_m, options.walk_m + (options.walk_m_s + velocity_noise_m_s) * gone_s) +
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

// Kuhn 1955 with potentials: assigns one row after the other by a shortest augmenting path. As many
// columns of weight 0 as there are rows stand for "none". Rows and columns count from 1; 0 is the
// root of the path.
class HungarianMethod {
 public:
  HungarianMethod(const std::vector<std::vector<double>>& weight, size_t columns)
      : weight_(weight),
        columns_(columns),
        width_(columns + weight.size()),
        row_potential_(weight.size() + 1, 0),
        column_potential_(width_ + 1, 0),
        row_of_(width_ + 1, 0),
        previous_(width_ + 1, 0) {}

  // The row of each column, 0 for none.
  std::vector<size_t> Run() {
    for (size_t row = 1; row <= weight_.size(); ++row) AssignRow(row);
    return row_of_;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  double Cost(size_t row, size_t column) const {
    return column <= columns_ ? -std::max(0.0, weight_[row - 1][column - 1]) : 0.0;
  }

  void AssignRow(size_t row) {
    shortest_.assign(width_ + 1, kFar);
    done_.assign(width_ + 1, 0);
    row_of_[0] = row;
    size_t column = 0;
    while (row_of_[column] != 0) column = ExtendPath(column);
    for (; column != 0; column = previous_[column]) row_of_[column] = row_of_[previous_[column]];
  }

  // Continues the path from a column to the nearest one that it has not reached, which is returned.
  size_t ExtendPath(size_t column) {
    done_[column] = 1;
    const size_t row = row_of_[column];
    size_t next = 0;
    double step = kFar;
    for (size_t c = 1; c <= width_; ++c) {
      if (done_[c]) continue;
      const double reduced = Cost(row, c) - row_potential_[row] - column_potential_[c];
      if (reduced < shortest_[c]) shortest_[c] = reduced, previous_[c] = column;
      if (shortest_[c] < step) step = shortest_[c], next = c;
    }
    ShiftPotentials(step);
    return next;
  }

  void ShiftPotentials(double step) {
    for (size_t c = 0; c <= width_; ++c) {
      if (done_[c]) {
        row_potential_[row_of_[c]] += step;
        column_potential_[c] -= step;
      } else {
        shortest_[c] -= step;
      }
    }
  }

  const std::vector<std::vector<double>>& weight_;
  size_t columns_, width_;
  std::vector<double> row_potential_, column_potential_;
  std::vector<size_t> row_of_, previous_;
  std::vector<double> shortest_;
  std::vector<uint8_t> done_;
};

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

double ComputeLostTrackLogOdds(const PointGrid& grid, const Track& lost,
                               const Eigen::Vector3f& place_m, const FrameMeasures& measures,
                               Entrance entrance, double time_s, const ReidentifyOptions& options) {
  double density = ComputePlaceDensity_per_m2(grid, lost, place_m, time_s, options);
  const bool from_behind = entrance == Entrance::kBehind;
  if (lost.lost_behind != from_behind) density *= options.unexpected_entrance;
  return std::log(density / ExpectNewPeople_per_m2(entrance, options)) +
         CompareMeasures(lost.measures, measures, from_behind, options.measures);
}

std::vector<int> FindBestAssignment(const std::vector<std::vector<double>>& weight,
                                    size_t columns) {
  const std::vector<size_t> row_of = HungarianMethod(weight, columns).Run();
  std::vector<int> column_of(weight.size(), -1);
  for (size_t c = 1; c <= columns; ++c) {
    const size_t row = row_of[c];
    if (row != 0 && weight[row - 1][c - 1] > 0) column_of[row - 1] = static_cast<int>(c) - 1;
  }
  return column_of;
}

}  // namespace ossa::people
