#include "depth/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "depth/scene/heads.h"

namespace ossa::depth {
namespace {

using Eigen::Vector3f;

// A frame of another size or a clock that jumped back starts over.
void ForgetIfStrange(const DepthFrame& frame, SceneState& state) {
  if (state.frame_width == frame.camera.width && state.frame_height == frame.camera.height) return;
  const int next_id = state.next_id;
  state = {};
  state.next_id = next_id;
  state.frame_width = frame.camera.width;
  state.frame_height = frame.camera.height;
}

// Which user of the frame before each cell belongs to: same cell, similar depth. -1 for none.
std::vector<int> PreviousOwners(const PointGrid& grid, const SceneState& state) {
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  for (size_t u = 0; u < state.users.size(); ++u) {
    const UserTrack& user = state.users[u];
    for (size_t i = 0; i < user.cells.size(); ++i) {
      const int cell = user.cells[i];
      if (cell < grid.cells() && grid.valid(cell) && std::abs(grid.z(cell) - user.z_m[i]) < 0.12F) {
        owner[static_cast<size_t>(cell)] = static_cast<int>(u);
      }
    }
  }
  return owner;
}

// Cells of the region per user of before.
std::vector<std::vector<int>> Overlaps(const Region& region, const std::vector<int>& owner,
                                       size_t users) {
  std::vector<std::vector<int>> overlap(users);
  for (const int cell : region.cells) {
    const int u = owner[static_cast<size_t>(cell)];
    if (u >= 0) overlap[static_cast<size_t>(u)].push_back(cell);
  }
  return overlap;
}

// A disc around a head belongs to it before anything is measured over the surface.
std::vector<int> HeadSeed(const PointGrid& grid, const Region& region, const Vector3f& head) {
  std::vector<int> seed;
  for (const int cell : region.cells) {
    if ((grid.at(cell) - head).norm() < 0.12F) seed.push_back(cell);
  }
  return seed;
}

Region Joined(const PointGrid& grid, const Region& a, const Region& b) {
  std::vector<int> cells = a.cells;
  cells.insert(cells.end(), b.cells.begin(), b.cells.end());
  return MakeRegion(grid, std::move(cells));
}

// The shortest way between the cells of a small piece and a big one, metres; only nearby cells of
// the image are compared, and a piece behind the other does not reach around it.
float Gap(const PointGrid& grid, const Region& small, const std::vector<int>& label, int big) {
  float best = 1e9F;
  for (const int cell : small.cells) {
    const int x = cell % grid.width, y = cell / grid.width;
    const int reach = std::clamp(static_cast<int>(grid.CellsOf(0.12F, grid.z(cell))), 3, 16);
    for (int dy = -reach; dy <= reach; dy += 2) {
      for (int dx = -reach; dx <= reach; dx += 2) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int other = grid.cell(x + dx, y + dy);
        if (label[static_cast<size_t>(other)] != big) continue;
        best = std::min(best, (grid.at(other) - grid.at(cell)).norm());
      }
    }
  }
  return best;
}

// Hands held out, forearms cut off by the projector's shadow, legs below a table: small pieces join
// the big piece they are nearest to, if an arm could bridge the way. Pieces far behind do not.
std::vector<Region> JoinPieces(const PointGrid& grid, std::vector<Region> regions) {
  constexpr float kPieceArea_m2 = 0.12F, kReach_m = 0.42F;
  std::vector<int> label(static_cast<size_t>(grid.cells()), -1);
  std::vector<Region> big, small;
  for (Region& region : regions) {
    const bool whole = region.area_m2 >= kPieceArea_m2;
    (whole ? big : small).push_back(std::move(region));
    if (!whole) continue;
    for (const int cell : big.back().cells) {
      label[static_cast<size_t>(cell)] = static_cast<int>(big.size()) - 1;
    }
  }
  for (const Region& piece : small) {
    int best = -1;
    float best_gap = kReach_m;
    for (size_t i = 0; i < big.size(); ++i) {
      const float gap = Gap(grid, piece, label, static_cast<int>(i));
      if (gap < best_gap) best_gap = gap, best = static_cast<int>(i);
    }
    if (best >= 0) {
      big[static_cast<size_t>(best)] = Joined(grid, big[static_cast<size_t>(best)], piece);
    } else {
      big.push_back(piece);
    }
  }
  return big;
}

// Pieces that mostly cover where one user was belong together: an arm of somebody in front may cut
// a body in two.
std::vector<Region> JoinByHistory(const PointGrid& grid, std::vector<Region> regions,
                                  const std::vector<int>& owner, size_t users) {
  std::vector<int> home(users, -1);
  std::vector<Region> result;
  for (Region& region : regions) {
    const auto overlap = Overlaps(region, owner, users);
    int join = -1;
    for (size_t u = 0; u < users; ++u) {
      if (overlap[u].size() * 2 < region.cells.size()) continue;
      if (home[u] >= 0)
        join = home[u];
      else
        home[u] = static_cast<int>(result.size());
    }
    if (join >= 0) {
      result[static_cast<size_t>(join)] = Joined(grid, result[static_cast<size_t>(join)], region);
    } else {
      result.push_back(std::move(region));
    }
  }
  return result;
}

// Who is in one region: users of before by the cells they held, newcomers by their heads.
std::vector<std::vector<int>> SeedsOf(const PointGrid& grid, const Region& region,
                                      const std::vector<int>& owner, size_t users) {
  std::vector<std::vector<int>> seeds;
  std::vector<uint8_t> owned(static_cast<size_t>(grid.cells()), 0);
  for (auto& cells : Overlaps(region, owner, users)) {
    if (cells.size() < 40) continue;
    for (const int cell : cells) owned[static_cast<size_t>(cell)] = 1;
    seeds.push_back(std::move(cells));
  }
  for (const HeadBlob& head : FindHeads(grid, region)) {
    std::vector<int> seed = HeadSeed(grid, region, head.position_m);
    const auto taken = std::count_if(
        seed.begin(), seed.end(), [&](int cell) { return owned[static_cast<size_t>(cell)] != 0; });
    if (2 * taken < static_cast<long>(seed.size())) seeds.push_back(std::move(seed));
  }
  return seeds;
}

// Full-resolution pixels of a region: each pixel follows the nearest cell around it of its depth.
std::vector<int32_t> PixelsOf(const DepthFrame& frame, const PointGrid& grid,
                              const Region& region) {
  const DepthView depth = frame.view();
  std::vector<uint8_t> member(static_cast<size_t>(grid.cells()), 0);
  std::vector<uint8_t> touched(member.size(), 0);
  int low = grid.height, high = 0;
  for (const int cell : region.cells) {
    member[static_cast<size_t>(cell)] = 1;
    const int x = cell % grid.width, y = cell / grid.width;
    low = std::min(low, std::max(0, y - 1)),
    high = std::max(high, std::min(grid.height - 1, y + 1));
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (grid.Contains(x + dx, y + dy))
          touched[static_cast<size_t>(grid.cell(x + dx, y + dy))] = 1;
      }
    }
  }
  const auto belongs = [&](int x, int y, uint16_t mm) {
    const auto z = static_cast<float>(MetresFromMillimetres(mm));
    float best = 0.06F + DepthTolerance(z);
    bool mine = false;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int cell = grid.cell(x + dx, y + dy);
        // The own cell wins ties against its neighbours.
        const float off = std::abs(grid.z(cell) - z) + (dx != 0 || dy != 0 ? 0.02F : 0.0F);
        if (grid.valid(cell) && off < best)
          best = off, mine = member[static_cast<size_t>(cell)] != 0;
      }
    }
    return mine;
  };
  std::vector<int32_t> pixels;
  pixels.reserve(region.cells.size() * static_cast<size_t>(grid.step * grid.step));
  for (int v = low * grid.step; v < std::min(depth.height, (high + 1) * grid.step); ++v) {
    for (int x = 0; x < grid.width; ++x) {
      if (!touched[static_cast<size_t>(grid.cell(x, v / grid.step))]) continue;
      for (int u = x * grid.step; u < std::min(depth.width, (x + 1) * grid.step); ++u) {
        const uint16_t mm = depth.at(u, v);
        if (mm > 0 && belongs(x, v / grid.step, mm)) pixels.push_back(v * depth.width + u);
      }
    }
  }
  return pixels;
}

bool PersonSized(const Region& region, const SceneOptions& options) {
  const Vector3f size = region.high_m - region.low_m;
  const float length = std::max(size.y(), std::max(size.x(), size.z()));
  return region.area_m2 >= options.min_area_m2 && length >= options.min_height_m &&
         region.cells.size() >= 30;
}

double FlatShare(const Region& region, const RoomShape& shape) {
  const auto flat = std::count_if(region.cells.begin(), region.cells.end(), [&](int cell) {
    return shape.flat[static_cast<size_t>(cell)] != 0;
  });
  return static_cast<double>(flat) / static_cast<double>(std::max<size_t>(1, region.cells.size()));
}

// One piece per person. A seed whose piece could not be a person was no head: its piece goes back
// to the others.
std::vector<Region> CutBySeeds(const PointGrid& grid, const Region& region,
                               std::vector<std::vector<int>> seeds, const SceneOptions& options) {
  while (true) {
    // One person alone needs no cut, unless much more hangs on than a person has.
    if (seeds.empty() || (seeds.size() == 1 && region.area_m2 <= 1.0F)) return {region};
    std::vector<Region> pieces = SplitBySeeds(grid, region, seeds, options.max_reach_m);
    if (seeds.size() == 1) return pieces;
    size_t least = 0;
    for (size_t i = 1; i < pieces.size(); ++i) {
      if (pieces[i].area_m2 < pieces[least].area_m2) least = i;
    }
    if (PersonSized(pieces[least], options)) return pieces;
    seeds.erase(seeds.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

}  // namespace

Scene FindCandidates(const DepthFrame& frame, const SceneState& state, SceneState& next,
                     const SceneOptions& options) {
  next = state;
  ForgetIfStrange(frame, next);
  Scene scene;
  scene.grid = MakePointGrid(frame.view(), frame.camera, options.max_depth_m);
  scene.floor = FindFloor(scene.grid, next.floor, options.floor);
  const RoomShape shape = RoomSurfaces(scene.grid, scene.floor);
  std::vector<uint8_t> ignore = shape.room;
  const std::vector<uint8_t> background =
      SeenBackground(scene.grid, next.background, options.background);
  const std::vector<int> owner = PreviousOwners(scene.grid, next);
  for (size_t i = 0; i < ignore.size(); ++i) ignore[i] |= background[i] && owner[i] < 0;

  constexpr float kSpeck_m2 = 0.004F;  // a fist has 0.006
  std::vector<Region> regions = ConnectedRegions(scene.grid, ignore, kSpeck_m2);
  regions = JoinPieces(scene.grid, std::move(regions));
  regions = JoinByHistory(scene.grid, std::move(regions), owner, next.users.size());
  for (const Region& region : regions) {
    if (!PersonSized(region, options)) continue;
    const auto seeds = SeedsOf(scene.grid, region, owner, next.users.size());
    for (Region& piece : CutBySeeds(scene.grid, region, seeds, options)) {
      if (!PersonSized(piece, options)) continue;
      Candidate candidate;
      candidate.pixels = PixelsOf(frame, scene.grid, piece);
      candidate.has_head = !seeds.empty();
      candidate.flat_share = FlatShare(piece, shape);
      candidate.region = std::move(piece);
      scene.candidates.push_back(std::move(candidate));
    }
  }
  for (Candidate& candidate : scene.candidates) {
    const auto overlap = Overlaps(candidate.region, owner, next.users.size());
    size_t best = 0;
    for (size_t u = 0; u < overlap.size(); ++u) {
      if (overlap[u].size() > best) best = overlap[u].size(), candidate.track = static_cast<int>(u);
    }
  }
  std::stable_sort(
      scene.candidates.begin(), scene.candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.region.area_m2 > b.region.area_m2; });
  return scene;
}

std::vector<Candidate> SplitCandidate(const Scene& scene, const DepthFrame& frame,
                                      const Candidate& candidate,
                                      const std::vector<Eigen::Vector3d>& heads_m,
                                      const SceneOptions& options) {
  std::vector<std::vector<int>> seeds;
  for (const auto& head : heads_m) {
    auto seed = HeadSeed(scene.grid, candidate.region, head.cast<float>());
    if (!seed.empty()) seeds.push_back(std::move(seed));
  }
  if (seeds.size() < 2) return {candidate};
  std::vector<Candidate> pieces;
  for (Region& piece : SplitBySeeds(scene.grid, candidate.region, seeds, options.max_reach_m)) {
    if (!PersonSized(piece, options)) continue;
    Candidate part;
    part.pixels = PixelsOf(frame, scene.grid, piece);
    part.track = pieces.empty() ? candidate.track : -1;
    part.has_head = true;
    part.flat_share = candidate.flat_share;
    part.region = std::move(piece);
    pieces.push_back(std::move(part));
  }
  return pieces;
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
