#include "tools/people/update_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "tools/people/reidentify.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

using Eigen::Vector3f;

// While a person is partly occluded, the visible centroid moves with the occluder: the track is
// predicted with constant velocity, within a distance of the visible centroid.
void MoveHidden(const Region& region, double time_s, const MotionOptions& options, Track& track) {
  const Vector3f expected = PredictMean_m(track, time_s, options.max_hidden_s) - region.mean_m;
  const float far_m = expected.norm();
  const float share = far_m > options.max_hidden_m ? options.max_hidden_m / far_m : 1.0F;
  track.mean_m = region.mean_m + share * expected;
}

// The displacement of the body between two frames, by the keypoints seen in both: the mean of the
// middle half, because single ones jump. Nothing where there are too few.
std::optional<Vector3f> MeasureShift_m(const Keypoints& before_m, const Keypoints& now_m,
                                       size_t min_keypoints) {
  std::array<std::vector<float>, 3> way_m;
  for (size_t i = 0; i < std::min(before_m.size(), now_m.size()); ++i) {
    if (!before_m[i] || !now_m[i]) continue;
    for (int axis = 0; axis < 3; ++axis)
      way_m[static_cast<size_t>(axis)].push_back((*now_m[i])[axis] - (*before_m[i])[axis]);
  }
  const size_t count = way_m[0].size();
  if (count < min_keypoints) return std::nullopt;
  Vector3f shift_m;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float>& way = way_m[static_cast<size_t>(axis)];
    std::sort(way.begin(), way.end());
    const auto skipped = static_cast<std::ptrdiff_t>(count / 4);
    shift_m[axis] = std::accumulate(way.begin() + skipped, way.end() - skipped, 0.0F) /
                    static_cast<float>(static_cast<std::ptrdiff_t>(count) - 2 * skipped);
  }
  return shift_m;
}

// By keypoints where they are seen, also if partly occluded; else by the centroid of the surface,
// unless it is partly occluded and moves with the occluder.
template <class IsHidden>
void UpdateVelocity(const Detection& person, const IsHidden& is_hidden, float dt_s,
                    const MotionOptions& options, Track& track) {
  const auto shift_m = MeasureShift_m(track.keypoints_m, person.keypoints_m, options.min_keypoints);
  const bool in_time = dt_s > options.min_s && dt_s < options.max_s;
  if (!in_time || (!shift_m && track.cells.empty())) {
    track.velocity_m_s.setZero();
    track.velocity_frames = 0;
    return;
  }
  if (!shift_m && is_hidden()) return;
  ++track.velocity_frames;
  const float share =
      shift_m ? std::max(options.keypoint_share, 1.0F / static_cast<float>(track.velocity_frames))
              : options.surface_share;
  Vector3f velocity = (shift_m ? *shift_m : person.candidate.region.mean_m - track.mean_m) / dt_s;
  velocity.y() = 0;  // people walk horizontally
  track.velocity_m_s += share * (velocity - track.velocity_m_s);
  const float fast = track.velocity_m_s.norm();
  if (fast > options.max_m_s) track.velocity_m_s *= options.max_m_s / fast;
}

void UpdateMovement(const Region& region, double time_s, const MotionOptions& options,
                    Track& track) {
  if (track.first_m2 == 0) {
    track.first_mean_m = region.mean_m;
    track.first_m2 = region.area_m2;
  }
  if (track.rest_m2 == 0 || HasMoved(track.rest_mean_m, track.rest_m2, region, options)) {
    track.rest_mean_m = region.mean_m;
    track.rest_m2 = region.area_m2;
    track.moved_s = time_s;
  }
  track.moved = track.moved || HasMoved(track.first_mean_m, track.first_m2, region, options);
}

}  // namespace

std::vector<float> CollectDepths(const PointGrid& grid, const Region& region) {
  std::vector<float> z_m;
  z_m.reserve(region.cells.size());
  for (const int cell : region.cells) z_m.push_back(grid.z(cell));
  return z_m;
}

void UpdateTrack(const PointGrid& grid, const Detection& person, const std::vector<int>& person_of,
                 int self, double time_s, const AssociationOptions& options, Track& track) {
  const Region& region = person.candidate.region;
  const bool hidden = region.area_m2 < options.motion.half_hidden * track.full_m2;
  const auto is_hidden = [&] {
    return hidden || FindEntrance(grid, region.cells, CollectDepths(grid, region), person_of, self,
                                  options.reidentify) == Entrance::kBehind;
  };
  UpdateVelocity(person, is_hidden, static_cast<float>(time_s - track.last_seen_s), options.motion,
                 track);
  if (hidden && !track.cells.empty()) {
    MoveHidden(region, time_s, options.motion, track);
  } else {
    track.mean_m = region.mean_m;
  }
  // The joints of a partly occluded person are unreliable.
  if (!hidden) track.measures.Add(person.measures, options.reidentify.measures);
  UpdateMovement(region, time_s, options.motion, track);
  track.full_m2 = std::max(region.area_m2, options.motion.forget_area * track.full_m2);
  track.cells = region.cells;
  track.z_m = CollectDepths(grid, region);
  track.keypoints_m = person.keypoints_m;
  track.last_seen_s = time_s;
  track.entered = track.entered || IsForeground(person.candidate);
  track.lost_behind = false;
  track.score = person.score;
  ++track.age;
  track.facing = person.evidence.classification.context;
  track.facing_s = time_s;
  if (track.age >= options.certain_age && person.score >= options.certain_score)
    track.certain_until_s = time_s + options.certain_s;
}

void ResetEvidence(Track& track) {
  track.score.reset();
  track.age = 0;
  track.facing.clear();
}

}  // namespace ossa::people
