#include "depth/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "depth/scene/boards_internal.h"
#include "depth/scene/heads.h"
#include "depth/scene/outline_internal.h"
#include "depth/scene/pieces.h"
#include "depth/scene/region_pixels_internal.h"

namespace ossa::depth {
namespace {

using Eigen::Vector3f;

// True when this frame shows another scene than the one before: most of what was measured in both
// is elsewhere now. Nothing that moves in a room covers so much of it between two frames.
bool SceneChanged(const PointGrid& grid, const SceneState& state) {
  constexpr float kElsewhere_m = 0.15F;
  constexpr int kFewest = 500;
  if (state.last_z_m.size() != static_cast<size_t>(grid.cells())) return false;
  int both = 0, elsewhere = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    const float before = state.last_z_m[static_cast<size_t>(i)];
    if (!grid.valid(i) || before <= 0) continue;
    ++both;
    elsewhere += std::abs(grid.z(i) - before) > kElsewhere_m + 3 * DepthTolerance(before) ? 1 : 0;
  }
  return both > kFewest && 2 * elsewhere > both;
}

// A frame of another size or of another scene starts over.
void ForgetIfStrange(const DepthFrame& frame, const PointGrid& grid, SceneState& state) {
  const bool same_size =
      state.frame_width == frame.camera.width && state.frame_height == frame.camera.height;
  if (!same_size || SceneChanged(grid, state)) {
    const int next_id = state.next_id;
    state = {};
    state.next_id = next_id;
    state.frame_width = frame.camera.width;
    state.frame_height = frame.camera.height;
  }
  state.last_z_m.resize(static_cast<size_t>(grid.cells()));
  for (int i = 0; i < grid.cells(); ++i) state.last_z_m[static_cast<size_t>(i)] = grid.z(i);
}

// What is known of each cell.
struct CellFacts {
  const std::vector<int>& owner;       // user of the frame before
  const std::vector<uint8_t>& barred;  // it was nobody's, and is as it was
  const std::vector<uint8_t>& arrived;
  const RoomShape& shape;
  const std::optional<FloorPlane>& floor;
};

// A connected region as pieces that may be one person each.
std::vector<Candidate> CandidatesIn(const DepthFrame& frame, const PointGrid& grid,
                                    const Region& region, const CellFacts& facts,
                                    const SceneState& state, const SceneOptions& options) {
  const auto large_enough = [&](const Region& r) {
    return PersonSized(r, options) || ArrivedPersonSized(r, facts.arrived, options);
  };
  std::vector<Candidate> candidates;
  if (!large_enough(region)) return candidates;
  const auto seeds = SeedsOf(grid, region, facts.owner, state.users.size(), facts.barred, options);
  for (Region& piece : CutBySeeds(grid, region, seeds, options)) {
    if (!large_enough(piece)) continue;
    Candidate candidate;
    candidate.pixels = PixelsOf(frame, grid, piece);
    candidate.has_head = !seeds.empty();
    candidate.flat_share = ShareOf(piece, facts.shape.flat);
    candidate.board = BoardOf(piece, facts.shape);
    candidate.arrived_share = ShareOf(piece, facts.arrived);
    candidate.arrived_m2 = ArrivedArea_m2(grid, piece.cells, facts.arrived);
    candidate.hidden_share = HiddenShare(grid, facts.floor, piece);
    candidate.region = std::move(piece);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

// Who came into the room is not made of it: what was seen there before, nobody's, they enter by a
// rim only, however far they did in the frames before, or they would creep into what they pass.
void LetGoOfRoom(const PointGrid& grid, const SceneState& state, std::vector<int>& owner,
                 std::vector<uint8_t>& barred) {
  const std::vector<uint8_t> room = SeenItself(grid, state.background);
  for (size_t i = 0; i < owner.size(); ++i) {
    if (!room[i] || owner[i] < 0 || !state.users[static_cast<size_t>(owner[i])].came) continue;
    owner[i] = -1;
    barred[i] = 1;
  }
}

// Each user of before goes on in the one candidate that holds most of their cells, if that is a
// good part of either: what merely touches a person is not that person. Nor is the furniture they
// touched while they went out of view: it was seen there before, they were not.
void ContinueTracks(const std::vector<int>& owner, const std::vector<UserTrack>& users,
                    const std::vector<uint8_t>& seen_before, std::vector<Candidate>& candidates) {
  constexpr size_t kPart = 4;  // a quarter
  constexpr double kMostly = 0.5;
  std::vector<size_t> best(users.size(), 0);
  std::vector<int> heir(users.size(), -1);
  for (size_t c = 0; c < candidates.size(); ++c) {
    const Region& region = candidates[c].region;
    const auto overlap = Overlaps(region, owner, users.size());
    const bool of_room = ShareOf(region, seen_before) > kMostly;
    for (size_t u = 0; u < users.size(); ++u) {
      if (of_room && users[u].came) continue;
      const size_t common = overlap[u].size();
      const size_t least = std::min(region.cells.size(), users[u].cells.size()) / kPart;
      if (common <= std::max(best[u], least)) continue;
      best[u] = common;
      heir[u] = static_cast<int>(c);
    }
  }
  // Two users in one candidate: the one who fills more of it goes on.
  std::vector<size_t> filled(candidates.size(), 0);
  for (size_t u = 0; u < users.size(); ++u) {
    if (heir[u] < 0) continue;
    const auto c = static_cast<size_t>(heir[u]);
    if (best[u] <= filled[c]) continue;
    filled[c] = best[u];
    candidates[c].track = static_cast<int>(u);
  }
}

// Over the floor, from the nearer sides of two pieces.
float GapOnFloor_m(const PointGrid& grid, const Region& a, const Region& b) {
  const float aside_m = std::max({0.0F, a.low_m.x() - b.high_m.x(), b.low_m.x() - a.high_m.x()});
  return std::hypot(aside_m, grid.OnFloor(a.mean_m - b.mean_m).y());
}

// What comes into view close to somebody who is seen may be the rest of them: of it nothing is
// taken for granted.
void DoubtRests(const PointGrid& grid, const std::vector<UserTrack>& users, double time_s,
                std::vector<Candidate>& candidates) {
  constexpr float kClose_m = 0.45F, kBeside_m = 0.7F;
  for (Candidate& candidate : candidates) {
    if (candidate.track >= 0) continue;
    for (const Candidate& other : candidates) {
      if (other.track < 0) continue;
      const Vector3f off_m = PredictedMean_m(users[static_cast<size_t>(other.track)], time_s) -
                             candidate.region.mean_m;
      if (grid.OnFloor(off_m).norm() < kClose_m) candidate.arrived_share = 0;
      if (GapOnFloor_m(grid, candidate.region, other.region) < kBeside_m) candidate.alone = false;
    }
  }
}

void MarkReturning(const std::vector<UserTrack>& users, double time_s, const SceneOptions& options,
                   std::vector<Candidate>& candidates) {
  for (size_t u = 0; u < users.size(); ++u) {
    const auto goes_on = [u](const Candidate& c) { return c.track == static_cast<int>(u); };
    if (std::any_of(candidates.begin(), candidates.end(), goes_on)) continue;
    for (Candidate& candidate : candidates) {
      if (candidate.track < 0 && MayReturnAs(users[u], candidate.region, time_s, options))
        candidate.returning = true;
    }
  }
}

}  // namespace

Scene FindCandidates(const DepthFrame& frame, const SceneState& state, SceneState& next,
                     const SceneOptions& options) {
  next = state;
  Scene scene;
  scene.grid = MakePointGrid(frame.view(), frame.camera, options.max_depth_m);
  ForgetIfStrange(frame, scene.grid, next);
  // Also after a gap, in which nobody was asked for.
  std::erase_if(next.users, [&](const UserTrack& user) {
    return IsForgotten(user, frame.time_s, options.reidentify);
  });
  const double since_s = frame.time_s - next.last_s;
  scene.fresh = since_s < 0 || since_s > options.fresh_s;
  next.last_s = frame.time_s;
  scene.floor = FindFloor(scene.grid, next.floor, options.floor);
  if (scene.floor) scene.grid.up = scene.floor->coefficients.head<3>().cast<float>();
  const RoomShape shape = RoomSurfaces(scene.grid, scene.floor);
  std::vector<uint8_t> ignore = shape.room;
  const std::vector<uint8_t> background =
      SeenBackground(scene.grid, next.background, options.background);
  std::vector<int> owner = PreviousOwners(scene.grid, next, frame.time_s);
  for (size_t i = 0; i < ignore.size(); ++i) ignore[i] |= background[i] && owner[i] < 0;
  const std::vector<uint8_t> arrived = ArrivedSince(scene.grid, next.background);

  constexpr float kSpeck_m2 = 0.004F;  // a fist has 0.006
  std::vector<Region> regions = ConnectedRegions(scene.grid, ignore, kSpeck_m2);
  regions = JoinPieces(scene.grid, std::move(regions), shape, owner, next.users.size());
  regions = JoinBelow(scene.grid, std::move(regions), next.users.size(), owner);
  regions = JoinBehind(scene.grid, std::move(regions), arrived, owner, next.users.size());
  regions = JoinByHistory(scene.grid, std::move(regions), owner, next.users, frame.time_s);
  const std::vector<uint8_t> seen_before = SeenBefore(scene.grid, next.background);
  std::vector<uint8_t> barred = seen_before;
  for (size_t i = 0; i < barred.size(); ++i) barred[i] &= owner[i] < 0;
  LetGoOfRoom(scene.grid, next, owner, barred);
  const CellFacts facts{owner, barred, arrived, shape, scene.floor};
  for (size_t r = 0; r < regions.size(); ++r) {
    for (Candidate& candidate : CandidatesIn(frame, scene.grid, regions[r], facts, next, options)) {
      candidate.origin = static_cast<int>(r);
      scene.candidates.push_back(std::move(candidate));
    }
  }
  ContinueTracks(owner, next.users, seen_before, scene.candidates);
  MarkReturning(next.users, frame.time_s, options, scene.candidates);
  DoubtRests(scene.grid, next.users, frame.time_s, scene.candidates);
  std::stable_sort(
      scene.candidates.begin(), scene.candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.region.area_m2 > b.region.area_m2; });
  return scene;
}

std::vector<Candidate> SplitCandidate(const Scene& scene, const DepthFrame& frame,
                                      const Candidate& candidate,
                                      const std::vector<Eigen::Vector3d>& heads_m,
                                      const SceneOptions& options) {
  std::vector<Seed> seeds;
  for (const auto& head : heads_m) {
    auto seed = HeadSeed(scene.grid, candidate.region, head.cast<float>());
    if (!seed.empty()) seeds.push_back({std::move(seed), options.max_reach_m, nullptr});
  }
  if (seeds.size() < 2) return {candidate};
  std::vector<Candidate> pieces;
  for (Region& piece : SplitBySeeds(scene.grid, candidate.region, seeds)) {
    if (!PersonSized(piece, options)) continue;
    Candidate part;
    part.pixels = PixelsOf(frame, scene.grid, piece);
    part.track = pieces.empty() ? candidate.track : -1;
    part.has_head = true;
    part.origin = candidate.origin;
    part.flat_share = candidate.flat_share;
    part.arrived_share = candidate.arrived_share;
    part.alone = candidate.alone;
    part.hidden_share = candidate.hidden_share;
    part.region = std::move(piece);
    pieces.push_back(std::move(part));
  }
  return pieces;
}

bool Adjoining(const Scene& scene, const Candidate& a, const Candidate& b) {
  constexpr int kReach = 2;         // cells, over the shadow that an edge casts
  constexpr float kJump_m = 0.15F;  // from a shirt's hem to the trousers
  constexpr float kRim_m = 0.1F;    // narrower, something else may just touch
  const PointGrid& grid = scene.grid;
  std::vector<uint8_t> of_b(static_cast<size_t>(grid.cells()), 0);
  for (const int cell : b.region.cells) of_b[static_cast<size_t>(cell)] = 1;
  const auto meets = [&](int cell) {
    const int x = cell % grid.width, y = cell / grid.width;
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int other = grid.cell(x + dx, y + dy);
        if (of_b[static_cast<size_t>(other)] && std::abs(grid.z(other) - grid.z(cell)) < kJump_m)
          return true;
      }
    }
    return false;
  };
  // Each step along the rim is met by up to `kReach` cells, one above the other.
  const auto rim = std::count_if(a.region.cells.begin(), a.region.cells.end(), meets);
  return static_cast<float>(rim) > kReach * grid.CellsOf(kRim_m, a.region.mean_m.z());
}

bool HidesPartOf(const Scene& scene, const Candidate& board, const Candidate& person) {
  return board.board && StandsBehind(scene.grid, person.region, *board.board);
}

Candidate JoinCandidates(const Scene& scene, const DepthFrame& frame, const Candidate& a,
                         const Candidate& b) {
  const auto cells = [](const Candidate& c) { return static_cast<double>(c.region.cells.size()); };
  Candidate whole;
  whole.region = Joined(scene.grid, a.region, b.region);
  whole.pixels = PixelsOf(frame, scene.grid, whole.region);
  whole.track = a.track >= 0 ? a.track : b.track;
  whole.absorbed = a.absorbed;
  whole.absorbed.insert(whole.absorbed.end(), b.absorbed.begin(), b.absorbed.end());
  if (a.track >= 0 && b.track >= 0) whole.absorbed.push_back(b.track);
  whole.has_head = a.has_head || b.has_head;
  const double of_a = cells(a) / std::max(1.0, cells(a) + cells(b));
  whole.flat_share = of_a * a.flat_share + (1 - of_a) * b.flat_share;
  whole.arrived_share = of_a * a.arrived_share + (1 - of_a) * b.arrived_share;
  whole.arrived_m2 = a.arrived_m2 + b.arrived_m2;
  whole.alone = a.alone && b.alone;
  whole.hidden_share = of_a * a.hidden_share + (1 - of_a) * b.hidden_share;
  whole.origin = a.origin;
  return whole;
}

void KeepNear(const Scene& scene, const DepthFrame& frame, std::span<const Bone> bones,
              float reach_m, Candidate& candidate) {
  std::vector<int> kept;
  for (const int cell : candidate.region.cells) {
    const Vector3f& p = scene.grid.at(cell);
    const bool near = std::any_of(bones.begin(), bones.end(), [&](const Bone& bone) {
      const Vector3f along = bone.to_m - bone.from_m;
      const float share = (p - bone.from_m).dot(along) / std::max(1e-6F, along.squaredNorm());
      const Vector3f nearest = bone.from_m + std::clamp(share, 0.0F, 1.0F) * along;
      return (p - nearest).squaredNorm() < reach_m * reach_m;
    });
    if (near) kept.push_back(cell);
  }
  constexpr size_t kFew = 40;  // cells: taken off for less, edges would flicker
  if (kept.size() + kFew > candidate.region.cells.size() || kept.size() < kFew) return;
  candidate.region = MakeRegion(scene.grid, std::move(kept));
  candidate.pixels = PixelsOf(frame, scene.grid, candidate.region);
}

Image<uint8_t> UserImage(const DepthFrame& frame, const std::vector<const Candidate*>& people,
                         const std::vector<int>& ids) {
  Image<uint8_t> image(frame.camera.width, frame.camera.height);
  for (size_t i = 0; i < people.size(); ++i) {
    for (const int32_t pixel : people[i]->pixels) {
      image.data[static_cast<size_t>(pixel)] = static_cast<uint8_t>(ids[i]);
    }
  }
  return image;
}

}  // namespace ossa::depth
