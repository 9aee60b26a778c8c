#pragma once
#include <vector>

#include "depth/scene/heads.h"
#include "depth/scene/scene.h"

// How connected regions become pieces that may be one person each.
namespace ossa::depth {

/// Which user of the frame before each cell belongs to: near where the user's cells went, at a
/// similar depth. -1 for none.
std::vector<int> PreviousOwners(const PointGrid& grid, const SceneState& state, double time_s);

/// Cells of the region per user of before.
std::vector<std::vector<int>> Overlaps(const Region& region, const std::vector<int>& owner,
                                       size_t users);

/// The user of before who had most of the region's cells, at least half; -1 for none, and for a
/// region without cells.
int MostlyOf(const Region& region, const std::vector<int>& owner, size_t users);
bool MostlyArrived(const Region& region, const std::vector<uint8_t>& arrived);

/// A disc around a head belongs to it before anything is measured over the surface.
std::vector<int> HeadSeed(const PointGrid& grid, const Region& region, const Eigen::Vector3f& head);

Region Joined(const PointGrid& grid, const Region& a, const Region& b);

bool PersonSized(const Region& region, const SceneOptions& options);
/// What came here needs to show less.
bool ArrivedPersonSized(const Region& region, const std::vector<uint8_t>& arrived,
                        const SceneOptions& options);

/// Hands held out, forearms cut off by the projector's shadow, legs below a table: small pieces
/// join the big piece they are nearest to, if an arm could bridge the way. Pieces far behind do
/// not, nor those of another user of before, nor what shows of somebody over the back of a seat.
std::vector<Region> JoinPieces(const PointGrid& grid, std::vector<Region> regions,
                               const RoomShape& shape, const std::vector<int>& owner, size_t users);

/// True where on the way between two pieces is nothing but nearer surface.
bool HiddenBetween(const PointGrid& grid, const Region& a, const Region& b);

/// What shows of somebody at either side of somebody nearer, and above: pieces that came here and
/// were nobody's, one as far away as the other, with nothing but nearer surface on the way between
/// them, or one above the other.
std::vector<Region> JoinBehind(const PointGrid& grid, std::vector<Region> regions,
                               const std::vector<uint8_t>& arrived, const std::vector<int>& owner,
                               size_t users);

/// What shows of somebody above a table and below its top: nothing but nearer surface on the way
/// between them. Legs that are found below a user of before become that user's.
std::vector<Region> JoinBelow(const PointGrid& grid, std::vector<Region> regions, size_t users,
                              std::vector<int>& owner);

/// Pieces that mostly cover where one user was belong together: an arm of somebody in front may cut
/// a body in two. So do pieces that come out where somebody half hidden is. Largest first.
std::vector<Region> JoinByHistory(const PointGrid& grid, std::vector<Region> regions,
                                  const std::vector<int>& owner,
                                  const std::vector<UserTrack>& users, double time_s);

/// Where a user's middle is expected.
Eigen::Vector3f PredictedMean_m(const UserTrack& user, double time_s);

/// True where a user who is out of view is expected about now.
bool MayReturnAs(const UserTrack& user, const Region& region, double time_s,
                 const SceneOptions& options);

/// Who is in one region: users of before by the cells they held, newcomers by their heads. Users of
/// before do not grow into `barred` cells (1 = barred), which the result refers to.
std::vector<Seed> SeedsOf(const PointGrid& grid, const Region& region,
                          const std::vector<int>& owner, size_t users,
                          const std::vector<uint8_t>& barred, const SceneOptions& options);

/// One piece per person. A seed whose piece could not be a person was no head: its piece goes back
/// to the others.
std::vector<Region> CutBySeeds(const PointGrid& grid, const Region& region, std::vector<Seed> seeds,
                               const SceneOptions& options);

}  // namespace ossa::depth
