#include "depth/scene/pieces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "depth/scene/boards_internal.h"
#include "depth/scene/heads.h"

namespace ossa::depth {
namespace {

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

// Somebody comes out from behind somebody else in pieces: a piece that was nobody's is the user's
// of whom a good part is still hidden, if it is where the user is expected, or a stride from there
// and only nearer surface lies between, and not more than the user lacks. users.size() for none.
size_t ComesOutAs(const PointGrid& grid, const Region& piece, const std::vector<Region>& owned,
                  const std::vector<int>& home, const std::vector<UserTrack>& users,
                  double time_s) {
  constexpr float kHidden = 0.75F, kAside_m = 0.35F, kBehind_m = 0.25F, kStride_m = 0.6F;
  constexpr float kSideways_m2 = 0.3F;  // of an adult
  for (size_t u = 0; u < users.size(); ++u) {
    if (home[u] < 0) continue;
    const Region& seen = owned[static_cast<size_t>(home[u])];
    const auto lacks_it = [&](float full_m2) {
      return seen.area_m2 <= kHidden * full_m2 && seen.area_m2 + piece.area_m2 <= 1.1F * full_m2;
    };
    const Eigen::Vector3f off = PredictedMean_m(users[u], time_s) - piece.mean_m;
    const bool expected = std::abs(off.x()) < kAside_m && std::abs(off.z()) < kBehind_m;
    if (expected && lacks_it(users[u].full_m2)) return u;
    // Who was half hidden all along has more than was ever seen.
    const Eigen::Vector2f on_floor = grid.OnFloor(off);
    const bool a_stride_off =
        std::abs(on_floor.x()) < kStride_m && std::abs(on_floor.y()) < kBehind_m;
    if (a_stride_off && lacks_it(std::max(users[u].full_m2, kSideways_m2)) &&
        HiddenBetween(grid, seen, piece))
      return u;
  }
  return users.size();
}

// The seeds a head is nearest to, if it could be theirs: a running person's head moves 15 cm from
// one frame to the next. -1 for none.
int OwnerOfHead(const PointGrid& grid, const HeadBlob& head, std::span<const Seed> seeds) {
  constexpr float kStep_m = 0.25F;
  int mine = -1;
  float nearest_m = kStep_m;
  for (size_t i = 0; i < seeds.size(); ++i) {
    for (const int cell : seeds[i].cells) {
      const float off_m = (grid.at(cell) - head.position_m).norm();
      if (off_m < nearest_m) nearest_m = off_m, mine = static_cast<int>(i);
    }
  }
  return mine;
}

// One person alone needs no cut, unless much more hangs on than a person has, or than this one had
// a frame ago.
bool IsOnePerson(const Region& region, const Seed& seed) {
  constexpr float kMost_m2 = 1.0F;
  constexpr int kMuch = 40;  // cells
  if (region.area_m2 > kMost_m2) return false;
  if (seed.barred == nullptr) return true;
  return std::count_if(region.cells.begin(), region.cells.end(), [&](int cell) {
           return (*seed.barred)[static_cast<size_t>(cell)] != 0;
         }) < kMuch;
}

}  // namespace

std::vector<int> PreviousOwners(const PointGrid& grid, const SceneState& state, double time_s) {
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  // Where they would be if they went on as before, then, for who stopped, where they were.
  for (const bool moved : {true, false}) {
    for (size_t u = 0; u < state.users.size(); ++u) {
      const UserTrack& user = state.users[u];
      const auto dt_s = static_cast<float>(std::clamp(time_s - user.seen_s, 0.0, 0.1));
      const Eigen::Vector3f step_m =
          moved ? Eigen::Vector3f(dt_s * user.velocity_m_s) : Eigen::Vector3f::Zero();
      for (size_t i = 0; i < user.cells.size(); ++i) {
        const float z_m = user.z_m[i] + step_m.z();
        const float right = grid.CellsOf(-step_m.x(), z_m), down = grid.CellsOf(-step_m.y(), z_m);
        const int x = user.cells[i] % grid.width + static_cast<int>(std::lround(right));
        const int y = user.cells[i] / grid.width + static_cast<int>(std::lround(down));
        if (!grid.Contains(x, y)) continue;
        const int cell = grid.cell(x, y);
        int& mine = owner[static_cast<size_t>(cell)];
        if (mine < 0 && grid.valid(cell) && std::abs(grid.z(cell) - z_m) < 0.12F)
          mine = static_cast<int>(u);
      }
    }
  }
  return owner;
}

std::vector<std::vector<int>> Overlaps(const Region& region, const std::vector<int>& owner,
                                       size_t users) {
  std::vector<std::vector<int>> overlap(users);
  for (const int cell : region.cells) {
    const int u = owner[static_cast<size_t>(cell)];
    if (u >= 0) overlap[static_cast<size_t>(u)].push_back(cell);
  }
  return overlap;
}

int MostlyOf(const Region& region, const std::vector<int>& owner, size_t users) {
  if (region.cells.empty()) return -1;
  const auto overlap = Overlaps(region, owner, users);
  for (size_t u = 0; u < users; ++u) {
    if (2 * overlap[u].size() >= region.cells.size()) return static_cast<int>(u);
  }
  return -1;
}

bool MostlyArrived(const Region& region, const std::vector<uint8_t>& arrived) {
  return ShareOf(region, arrived) > 0.5;
}

std::vector<int> HeadSeed(const PointGrid& grid, const Region& region,
                          const Eigen::Vector3f& head) {
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

bool PersonSized(const Region& region, const SceneOptions& options) {
  const Eigen::Vector3f size = region.high_m - region.low_m;
  const float length = std::max(size.y(), std::max(size.x(), size.z()));
  return region.area_m2 >= options.min_area_m2 && length >= options.min_height_m &&
         region.cells.size() >= 30;
}

bool ArrivedPersonSized(const Region& region, const std::vector<uint8_t>& arrived,
                        const SceneOptions& options) {
  SceneOptions less = options;
  less.min_area_m2 = options.min_arrived_m2;
  less.min_height_m = options.min_arrived_height_m;
  return PersonSized(region, less) && MostlyArrived(region, arrived);
}

std::vector<Region> JoinPieces(const PointGrid& grid, std::vector<Region> regions,
                               const RoomShape& shape, const std::vector<int>& owner,
                               size_t users) {
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
  std::vector<int> owner_of_big;
  std::vector<std::optional<FlatPlane>> board;
  for (const Region& region : big) {
    owner_of_big.push_back(MostlyOf(region, owner, users));
    board.push_back(BoardOf(region, shape));
  }
  for (const Region& piece : small) {
    const int mine = MostlyOf(piece, owner, users);
    int best = -1;
    float best_gap = kReach_m;
    for (size_t i = 0; i < owner_of_big.size(); ++i) {
      if (mine >= 0 && owner_of_big[i] >= 0 && mine != owner_of_big[i]) continue;
      if (board[i] && StandsBehind(grid, piece, *board[i])) continue;
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

std::vector<Region> JoinByHistory(const PointGrid& grid, std::vector<Region> regions,
                                  const std::vector<int>& owner,
                                  const std::vector<UserTrack>& users, double time_s) {
  std::vector<int> home(users.size(), -1);
  std::vector<Region> owned, others;
  for (Region& region : regions) {
    const int user = MostlyOf(region, owner, users.size());
    int* place = user < 0 ? nullptr : &home[static_cast<size_t>(user)];
    if (place == nullptr) {
      others.push_back(std::move(region));
    } else if (*place < 0) {
      *place = static_cast<int>(owned.size());
      owned.push_back(std::move(region));
    } else {
      Region& whole = owned[static_cast<size_t>(*place)];
      whole = Joined(grid, whole, region);
    }
  }
  std::vector<Region> result;
  for (Region& region : others) {
    const size_t u = ComesOutAs(grid, region, owned, home, users, time_s);
    if (u == users.size()) {
      result.push_back(std::move(region));
    } else {
      Region& whole = owned[static_cast<size_t>(home[u])];
      whole = Joined(grid, whole, region);
    }
  }
  result.insert(result.end(), std::make_move_iterator(owned.begin()),
                std::make_move_iterator(owned.end()));
  std::stable_sort(result.begin(), result.end(),
                   [](const Region& a, const Region& b) { return a.area_m2 > b.area_m2; });
  return result;
}

std::vector<Seed> SeedsOf(const PointGrid& grid, const Region& region,
                          const std::vector<int>& owner, size_t users,
                          const std::vector<uint8_t>& barred, const SceneOptions& options) {
  std::vector<Seed> seeds;
  for (auto& cells : Overlaps(region, owner, users)) {
    if (cells.size() >= 40) seeds.push_back({std::move(cells), options.growth_m, &barred});
  }
  const size_t known = seeds.size();
  std::vector<uint8_t> has_head(known, 0);
  for (const HeadBlob& head : FindHeads(grid, region)) {
    const int mine = OwnerOfHead(grid, head, std::span(seeds).first(known));
    // A person has one head, and it moves: the best head at a user of before is that user's. More
    // heads are newcomers', unless they lie within the user as it was.
    std::vector<int> seed = HeadSeed(grid, region, head.position_m);
    if (mine >= 0 && !has_head[static_cast<size_t>(mine)]) {
      has_head[static_cast<size_t>(mine)] = 1;
      continue;
    }
    const auto taken = std::count_if(
        seed.begin(), seed.end(), [&](int cell) { return owner[static_cast<size_t>(cell)] >= 0; });
    if (2 * taken < static_cast<long>(seed.size()))
      seeds.push_back({std::move(seed), options.max_reach_m, nullptr});
  }
  return seeds;
}

std::vector<Region> CutBySeeds(const PointGrid& grid, const Region& region, std::vector<Seed> seeds,
                               const SceneOptions& options) {
  while (true) {
    if (seeds.empty() || (seeds.size() == 1 && IsOnePerson(region, seeds[0]))) return {region};
    std::vector<Region> pieces = SplitBySeeds(grid, region, seeds);
    if (seeds.size() == 1) return pieces;
    size_t least = 0;
    for (size_t i = 1; i < pieces.size(); ++i) {
      if (pieces[i].area_m2 < pieces[least].area_m2) least = i;
    }
    if (PersonSized(pieces[least], options)) return pieces;
    seeds.erase(seeds.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

}  // namespace ossa::depth
