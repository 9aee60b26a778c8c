#include <algorithm>
#include <vector>

#include "depth/scene/measure_scene.h"
#include "depth/scene/regions.h"
#include "tools/people/propose_candidates.h"
#include "tools/tracker/mount_finder_internal.h"

namespace ossa::tracker {
namespace {

/// Cells of connected regions, without the floor, that the lower image border cuts off: such as a
/// person in front of a wall, for a level camera that sees no floor.
std::vector<uint8_t> FindCutBelow(const depth::Scene& scene, const MountOptions& options) {
  const depth::PointGrid& grid = scene.grid;
  const int lowest = static_cast<int>((1.0 - options.rim_share) * grid.height) - 1;
  std::vector<uint8_t> cut(static_cast<size_t>(grid.cells()), 0);
  for (const depth::Region& piece :
       depth::FindConnectedRegions(grid, scene.surfaces.floor, options.piece_m2)) {
    const bool is_cut = std::any_of(piece.cells.begin(), piece.cells.end(),
                                    [&](int cell) { return cell / grid.width >= lowest; });
    for (const int cell : piece.cells) cut[static_cast<size_t>(cell)] = is_cut ? 1 : 0;
  }
  return cut;
}

}  // namespace

bool ShowsPerson(const BodyFrame& tracked) {
  const auto joined = std::ranges::count(tracked.decisions.candidates, people::Rule::kJoinedPieces,
                                         &people::Decision::rule);
  return std::ssize(tracked.bodies) > joined;
}

double HighestScore(const BodyFrame& tracked) {
  double highest = 0.0;
  for (const Body& body : tracked.bodies) highest = std::max(highest, body.person_score);
  return highest;
}

bool SeemsLevel(const BodyFrame& tracked, const MountOptions& options) {
  return tracked.floor || HighestScore(tracked) >= options.level_person;
}

bool MountRevision::IsDue(double time_s) {
  const double since_s = time_s - checked_s_;
  if (since_s >= 0 && since_s < every_s_) return false;
  checked_s_ = time_s;
  return true;
}

MountFinder::View MountRevision::Add(const BodyFrame& level, const BodyFrame& from_above) {
  using View = MountFinder::View;
  const bool only_level =
      from_above.bodies.empty() && HighestScore(level) >= options_.only_level_person;
  const bool seems_level = only_level || SeemsLevel(level, options_);
  const double sure = seems_level ? options_.sure_despite_level : options_.sure;
  View seen = View::kUnknown;
  if (HighestScore(from_above) >= sure) {
    seen = View::kFromAbove;
  } else if (seems_level && ShowsPerson(level)) {
    seen = View::kLevel;
  }
  const bool nobody = level.bodies.empty() && from_above.bodies.empty();
  every_s_ = nobody ? std::min(2.0 * every_s_, options_.seldom_s) : options_.every_s;
  if (seen == View::kUnknown) return seen;
  agreeing_ = seen == seen_ ? agreeing_ + 1 : 1;
  seen_ = seen;
  return agreeing_ >= options_.agreeing ? seen : View::kUnknown;
}

bool MountFinder::IsDue(const BodyFrame& tracked) {
  const double since_s = tracked.time_s - checked_s_;
  if (is_level_ || (since_s >= 0 && since_s < options_.every_s)) return false;
  checked_s_ = tracked.time_s;
  const bool seems_level = tracked.floor && ShowsPerson(tracked);
  if (seems_level) {
    Confirm(View::kLevel);
    is_level_ = ++level_checks_ >= options_.agreeing;
  }
  return !seems_level;
}

bool MountFinder::MayBeCutBelow(const BodyFrame& tracked) const {
  return checks_ > 0 && !ShowsPerson(tracked);
}

bool MountFinder::Confirm(View seen) {
  const bool is_first = ++checks_ == 1;
  if (seen == View::kUnknown) return false;
  const bool from_above = seen == View::kFromAbove;
  if (from_above) level_checks_ = 0;
  above_checks_ = from_above ? above_checks_ + 1 : 0;
  return from_above && (is_first || above_checks_ >= options_.agreeing);
}

bool MayBeFromAbove(const depth::DepthFrame& frame, bool may_be_cut_below,
                    const people::PeopleOptions& above, const MountOptions& options) {
  depth::SceneState empty_state;
  const depth::Scene scene = depth::MeasureScene(frame, empty_state, above.scene);
  if (!scene.floor) return false;
  int valid = 0, floor = 0;
  for (int cell = 0; cell < scene.grid.cells(); ++cell) {
    valid += scene.grid.valid(cell) ? 1 : 0;
    floor += scene.surfaces.floor[static_cast<size_t>(cell)] != 0 ? 1 : 0;
  }
  if (floor < options.floor_share * valid) return false;
  const auto proposed =
      people::ProposeCandidates(frame, scene, {}, above.association.reidentify, above.candidates);
  if (may_be_cut_below) {
    return std::ranges::any_of(proposed.candidates, &people::Candidate::has_head);
  }
  const std::vector<uint8_t> cut_below = FindCutBelow(scene, options);
  return std::any_of(proposed.candidates.begin(), proposed.candidates.end(),
                     [&](const people::Candidate& candidate) {
                       return candidate.has_head &&
                              depth::MeasureShare(candidate.region, cut_below) <= options.cut_share;
                     });
}

}  // namespace ossa::tracker
