#include "tools/people/track_prediction.h"

#include <algorithm>
#include <cmath>

namespace ossa::people {

using Eigen::Vector3f;

Vector3f PredictMean_m(const Track& track, double time_s, double max_prediction_s) {
  const auto dt = static_cast<float>(std::clamp(time_s - track.last_seen_s, 0.0, max_prediction_s));
  return track.mean_m + dt * track.velocity_m_s;
}

std::vector<int> PredictOwners(const PointGrid& grid, const std::vector<Track>& tracks,
                               double time_s, const PredictionOptions& options) {
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  // First with constant velocity, then, for people who stopped, at the old place.
  for (const bool moved : {true, false}) {
    for (size_t t = 0; t < tracks.size(); ++t) {
      const Track& track = tracks[t];
      const auto dt_s =
          static_cast<float>(std::clamp(time_s - track.last_seen_s, 0.0, options.max_step_s));
      const Vector3f step_m = moved ? Vector3f(dt_s * track.velocity_m_s) : Vector3f::Zero();
      for (size_t i = 0; i < track.cells.size(); ++i) {
        const float z_m = track.z_m[i] + step_m.z();
        const float right = grid.CellsOf(-step_m.x(), z_m), down = grid.CellsOf(-step_m.y(), z_m);
        const int x = track.cells[i] % grid.width + static_cast<int>(std::lround(right));
        const int y = track.cells[i] / grid.width + static_cast<int>(std::lround(down));
        if (!grid.Contains(x, y)) continue;
        const int cell = grid.cell(x, y);
        int& mine = owner[static_cast<size_t>(cell)];
        if (mine < 0 && grid.valid(cell) && std::abs(grid.z(cell) - z_m) < options.same_depth_m)
          mine = static_cast<int>(t);
      }
    }
  }
  return owner;
}

std::vector<std::vector<int>> CollectOverlaps(const Region& region, const std::vector<int>& owner,
                                              size_t tracks) {
  std::vector<std::vector<int>> overlap(tracks);
  for (const int cell : region.cells) {
    const int t = owner[static_cast<size_t>(cell)];
    if (t >= 0) overlap[static_cast<size_t>(t)].push_back(cell);
  }
  return overlap;
}

int FindMainOwner(const Region& region, const std::vector<int>& owner, size_t tracks) {
  if (region.cells.empty()) return -1;
  const auto overlap = CollectOverlaps(region, owner, tracks);
  for (size_t t = 0; t < tracks; ++t) {
    if (2 * overlap[t].size() >= region.cells.size()) return static_cast<int>(t);
  }
  return -1;
}

namespace {

// On the floor, from a region's centroid to a track's predicted one.
Eigen::Vector2f FindOffset_m(const PointGrid& grid, const Track& track, const Region& region,
                             double time_s, const PredictionOptions& options) {
  return grid.OnFloor(PredictMean_m(track, time_s, options.max_prediction_s) - region.mean_m);
}

}  // namespace

float MeasureOffset_m(const PointGrid& grid, const Track& track, const Region& region,
                      double time_s, const PredictionOptions& options) {
  return FindOffset_m(grid, track, region, time_s, options).norm();
}

bool IsRatherOf(const PointGrid& grid, const Region& region, const Track& lost, const Track& other,
                double time_s, const CandidateOptions& options) {
  const auto offset_m = [&](const Track& track) {
    return FindOffset_m(grid, track, region, time_s, options.prediction);
  };
  const Eigen::Vector2f to_other_m = offset_m(other);
  if (to_other_m.norm() > options.same_person_m) return true;
  const float deep_m = std::abs(to_other_m.y());
  return deep_m > options.other_depth_m &&
         std::abs(offset_m(lost).y()) < options.lost_depth_share * deep_m;
}

bool IsExpectedAt(const Track& track, const Region& region, double time_s,
                  const PredictionOptions& options) {
  const double gone_s = time_s - track.last_seen_s;
  const double gate_m = static_cast<double>(options.return_gate_m) +
                        static_cast<double>(options.return_speed_m_s) * std::max(0.0, gone_s);
  Vector3f off = PredictMean_m(track, time_s, options.max_prediction_s) - region.mean_m;
  off.y() *= options.height_weight;
  return static_cast<double>(off.norm()) < gate_m;
}

bool MayReturnAs(const Track& track, const Region& region, double time_s, double forget_s,
                 const PredictionOptions& options) {
  return time_s - track.last_seen_s < forget_s && IsExpectedAt(track, region, time_s, options);
}

bool HasMoved(const Vector3f& first_mean_m, float first_m2, const Region& now,
              const MotionOptions& options) {
  return (now.mean_m - first_mean_m).norm() > options.moved_m ||
         std::abs(now.area_m2 - first_m2) > options.moved_area * first_m2;
}

bool IsForgotten(const Track& track, double time_s, const ReidentifyOptions& options) {
  const double forget_s = track.lost_behind ? options.forget_occluded_s : options.forget_s;
  return time_s - track.last_seen_s > forget_s;
}

}  // namespace ossa::people
