// Foreground relative to a known background.
#include "depth/scene/background.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

// The cells of a person.
std::vector<int> CellsOfPerson(const CapsuleRender& render, const PointGrid& grid) {
  std::vector<int> cells;
  for (int i = 0; i < grid.cells(); ++i) {
    const int u = i % grid.width * grid.step, v = i / grid.width * grid.step;
    if (grid.valid(i) && render.person.at(u, v) > 0) cells.push_back(i);
  }
  return cells;
}

double MeasureShare(const std::vector<int>& cells, const std::vector<uint8_t>& marked) {
  double count = 0;
  for (const int cell : cells) count += marked[static_cast<size_t>(cell)] != 0 ? 1 : 0;
  return count / static_cast<double>(cells.size());
}

TEST(Foreground, DistinguishesArrivalsFromBackground) {
  const std::vector<tests::Box> stool = {{{0.6, -1.0, 2.45}, {0.95, -0.4, 2.8}}};
  const PointGrid before = GridOf(Shot({}, 0, stool));
  BackgroundState state;
  LearnBackground(before, std::vector<uint8_t>(static_cast<size_t>(before.cells()), 0), state);
  const CapsuleRender render = Shot({PersonAt(-0.2, 2.5)}, 1, stool);
  const PointGrid now = GridOf(render);
  const auto foreground = CompareWithBackground(now, state).foreground;
  // Feet stand on the floor that was seen there, at its own depth.
  EXPECT_GT(MeasureShare(CellsOfPerson(render, now), foreground), 0.85);
  const PointGrid empty = GridOf(Shot({}));
  std::vector<int> of_stool;
  for (int i = 0; i < now.cells(); ++i) {
    if (before.z(i) < empty.z(i) - 0.1F && now.z(i) > before.z(i) - 0.05F) of_stool.push_back(i);
  }
  ASSERT_GT(of_stool.size(), 100U);
  EXPECT_EQ(MeasureShare(of_stool, foreground), 0.0);  // without noise
}

TEST(Foreground, DetectsAPersonInFrontOfATooFarBackground) {
  CapsuleScene scene;
  scene.planes = {{{0, 1, 0}, 1.0}, {{0, 0, -1}, 7.5}};  // the wall is beyond the 6 m looked at
  const PointGrid before = GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
  BackgroundState state;
  LearnBackground(before, std::vector<uint8_t>(static_cast<size_t>(before.cells()), 0), state);
  scene.people = {PersonAt(0, 4.0)};
  const CapsuleRender render = tests::Render(scene, KinectV1Camera(320, 240));
  const PointGrid now = GridOf(render);
  const auto foreground = CompareWithBackground(now, state).foreground;
  EXPECT_GT(MeasureShare(CellsOfPerson(render, now), foreground), 0.85);
}

// A wall at `z_m` in every cell of 40 x 30; 0 for no reading.
PointGrid WallAt(float z_m) {
  DepthFrame frame;
  frame.camera = KinectV1Camera(40, 30);
  frame.depth_mm.assign(40 * 30, static_cast<uint16_t>(std::lround(1000 * z_m)));
  return MakePointGrid(frame.view(), frame.camera, 6.0F);
}

// The wall, seen for so many frames; `claimed`: by people.
void See(float z_m, int frames, BackgroundState& state, bool claimed = false) {
  const PointGrid grid = WallAt(z_m);
  const std::vector<uint8_t> claims(static_cast<size_t>(grid.cells()), claimed ? 1 : 0);
  for (int f = 0; f < frames; ++f) {
    ForgetIfSensorMoved(grid, state);
    LearnBackground(grid, claims, state);
  }
}

// Whether a mask has all cells; it has none otherwise.
bool HasAll(const std::vector<uint8_t>& mask) {
  const auto count = std::count(mask.begin(), mask.end(), 1);
  EXPECT_TRUE(count == 0 || count == 40 * 30) << count;
  return count > 0;
}

// Whether a wall at this depth is the background, or foreground.
bool IsBackground(float z_m, const BackgroundState& state) {
  return HasAll(CompareWithBackground(WallAt(z_m), state).steady);
}
bool IsForeground(float z_m, const BackgroundState& state) {
  return HasAll(CompareWithBackground(WallAt(z_m), state).foreground);
}

TEST(Foreground, IsWhatAppearsWhereNothingWasForTwentyFrames) {
  BackgroundState state;
  See(0.0F, 19, state);
  EXPECT_FALSE(IsForeground(2.5F, state));
  See(0.0F, 1, state);
  EXPECT_TRUE(IsForeground(2.5F, state));
  See(2.5F, 60, state, true);  // a person stands there
  EXPECT_TRUE(IsForeground(2.5F, state));
  See(2.5F, 21, state);  // a chair
  EXPECT_FALSE(IsForeground(2.5F, state));
  EXPECT_TRUE(IsBackground(2.5F, state));
}

TEST(Foreground, IsNotBehindASurfaceThatHadNoReadingForAWhile) {
  BackgroundState state;
  See(3.0F, 1, state);
  See(0.0F, 60, state);
  EXPECT_FALSE(IsForeground(3.5F, state));
  EXPECT_TRUE(IsForeground(2.5F, state));
}

TEST(Background, ShareThatIsCertainGrowsFromNothingToAllButThePerson) {
  const PointGrid empty = GridOf(Shot({})), now = GridOf(Shot({PersonAt(0, 2.5)}));
  const std::vector<uint8_t> nobody(static_cast<size_t>(empty.cells()), 0);
  BackgroundState state;
  EXPECT_EQ(CompareWithBackground(empty, state).certain_share, 0.0);
  for (int f = 0; f < BackgroundOptions().certain_frames; ++f)
    LearnBackground(empty, nobody, state);
  EXPECT_EQ(CompareWithBackground(empty, state).certain_share, 1.0);
  const double beside_person = CompareWithBackground(now, state).certain_share;
  EXPECT_GT(beside_person, 0.8);
  EXPECT_LT(beside_person, 0.98);
}

TEST(Background, LearnsSurfacesUnclaimedForTwentyFrames) {
  BackgroundState state;
  See(3.0F, 19, state);
  EXPECT_FALSE(IsBackground(3.0F, state));
  See(3.0F, 1, state);
  EXPECT_TRUE(IsBackground(3.0F, state));
  EXPECT_FALSE(IsBackground(2.5F, state));
}

TEST(Background, DoesNotLearnAStandingPerson) {
  BackgroundState state;
  See(2.0F, 60, state, true);
  EXPECT_FALSE(IsBackground(2.0F, state));
}

// A cupboard moved in front of the wall becomes background after as long as the wall was seen, plus
// the usual time.
TEST(Background, AdaptsToMovedFurniture) {
  BackgroundState state;
  See(3.0F, 30, state);
  See(2.0F, 30, state);
  EXPECT_FALSE(IsBackground(2.0F, state));
  See(2.0F, 20, state);
  EXPECT_TRUE(IsBackground(2.0F, state));
  EXPECT_FALSE(IsBackground(3.0F, state));
}

TEST(Background, OccludedCellsKeepTheirBackground) {
  BackgroundState state;
  See(3.0F, 20, state);
  See(2.0F, 100, state, true);
  EXPECT_TRUE(IsBackground(3.0F, state));
}

TEST(Background, CellsWithoutAReadingKeepTheirBackground) {
  BackgroundState state;
  See(3.0F, 20, state);
  See(0.0F, 100, state);
  EXPECT_TRUE(IsBackground(3.0F, state));
}

TEST(Background, PersistsIndefinitely) {
  BackgroundState state;
  for (int i = 0; i < 30; ++i) {
    See(3.0F, 20, state);
    EXPECT_TRUE(IsBackground(3.0F, state)) << i;
  }
}

TEST(Background, IsUnknownForAnImageOfAnotherHeight) {
  BackgroundState state;
  See(3.0F, 20, state);
  PointGrid lower;
  lower.width = 40;
  lower.height = 60;
  lower.point_m.assign(40 * 60, {0, 0, 1.0F});
  const BackgroundMasks masks = CompareWithBackground(lower, state);
  for (const auto* mask : {&masks.steady, &masks.known, &masks.certain, &masks.foreground}) {
    EXPECT_EQ(*mask, std::vector<uint8_t>(40 * 60, 0));
  }
}

// If all known cells are suddenly farther away, it is not a person who left.
TEST(Background, IsResetWhenTheSensorMoves) {
  BackgroundState state;
  See(3.0F, 60, state);
  See(4.0F, 1, state, true);
  EXPECT_EQ(std::count(state.steady.begin(), state.steady.end(), 0), 40 * 30);
}

// What was learned of somebody before they were recognised is forgotten, unless it was seen for so
// long that it is background.
TEST(Background, ForgetsAPersonWhoWasNotRecognisedAtFirst) {
  const auto is_certain_after = [](int frames) {
    const CapsuleRender render = Shot({PersonAt(0, 2.5)});
    const PointGrid grid = GridOf(render);
    const std::vector<int> cells = CellsOfPerson(render, grid);
    const std::vector<uint8_t> nobody(static_cast<size_t>(grid.cells()), 0);
    BackgroundState state;
    for (int f = 0; f < frames; ++f) LearnBackground(grid, nobody, state);
    ForgetBackground(grid, cells, state);
    return MeasureShare(cells, CompareWithBackground(grid, state).certain);
  };
  EXPECT_EQ(is_certain_after(BackgroundOptions{}.steady_frames - 1), 0.0);
  EXPECT_EQ(is_certain_after(BackgroundOptions{}.steady_frames), 1.0);
}

// A room whose walls meet in front of a sensor that is turned to the left by this angle, and so far
// from them; with people.
PointGrid TurnedBy(double yaw_rad, const std::vector<CapsulePose>& people = {},
                   double wall_m = 3.0) {
  CapsuleScene scene;
  scene.people = people;
  for (const double wall_rad : {-0.7, 0.8}) {
    const double angle_rad = wall_rad + yaw_rad;
    scene.planes.push_back({{std::sin(angle_rad), 0, -std::cos(angle_rad)}, wall_m});
  }
  scene.planes.push_back({{0, 1, 0}, 1.0});
  return GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
}

// Whether a model that knows the room, with as many cells of people in it, is kept when the sensor
// sees this.
bool IsKept(const PointGrid& now, size_t claimed = 0) {
  BackgroundState state;
  const PointGrid before = TurnedBy(0);
  std::vector<uint8_t> of_people(static_cast<size_t>(before.cells()), 0);
  for (int f = 0; f < 30; ++f) LearnBackground(before, of_people, state);
  std::fill_n(of_people.begin(), claimed, uint8_t{1});
  LearnBackground(before, of_people, state);
  ForgetIfSensorMoved(now, state);
  return state.width > 0;
}

// 5 degrees: a knock against a tripod.
TEST(Background, IsForgottenWhenTheSensorIsTurnedByFiveDegrees) {
  for (const double yaw_rad : {-0.087, 0.087}) EXPECT_FALSE(IsKept(TurnedBy(yaw_rad))) << yaw_rad;
}

TEST(Background, IsForgottenWhenTheSensorApproachesTheWalls) {
  EXPECT_TRUE(IsKept(TurnedBy(0, {}, 2.95)));
  EXPECT_FALSE(IsKept(TurnedBy(0, {}, 2.6)));
}

// Where people are, nearer surfaces are theirs.
TEST(Background, IsKeptWhenPeopleWhoFillTheImageApproach) {
  const PointGrid now = TurnedBy(0, {}, 2.6);
  EXPECT_TRUE(IsKept(now, static_cast<size_t>(now.cells()) * 2 / 3));
}

TEST(Background, IsKeptWhenPeopleCome) {
  EXPECT_TRUE(IsKept(TurnedBy(0)));
  EXPECT_TRUE(IsKept(TurnedBy(0, {PersonAt(0, 1.0), PersonAt(0.6, 1.5)})));
}

TEST(ForegroundArea, ExcludesRims) {
  const PointGrid grid = GridOf(Shot({}));
  std::vector<uint8_t> foreground(static_cast<size_t>(grid.cells()), 0);
  std::vector<int> cells;
  for (int y = 40; y < 60; ++y) {
    for (int x = 80; x < 82; ++x)
      cells.push_back(grid.cell(x, y)), foreground[static_cast<size_t>(cells.back())] = 1;
  }
  EXPECT_EQ(MeasureForegroundArea_m2(grid, cells, foreground), 0.0F);
  for (int y = 40; y < 60; ++y)
    cells.push_back(grid.cell(82, y)), foreground[static_cast<size_t>(cells.back())] = 1;
  EXPECT_GT(MeasureForegroundArea_m2(grid, cells, foreground), 0.0F);
}

TEST(PointGrid, HeadAndFeetShareAFloorPositionForATiltedSensor) {
  const float tilt_rad = 0.35F;
  PointGrid grid;
  grid.up = {0, std::cos(tilt_rad), -std::sin(tilt_rad)};
  const Eigen::Vector3f feet_m(0.5F, -1.0F, 3.0F), head_m = feet_m + 1.7F * grid.up;
  EXPECT_LT((grid.OnFloor(head_m) - grid.OnFloor(feet_m)).norm(), 1e-5F);
  const Eigen::Vector3f beside_m = feet_m + Eigen::Vector3f(0.3F, 0, 0);
  EXPECT_NEAR((grid.OnFloor(beside_m) - grid.OnFloor(feet_m)).x(), 0.3F, 1e-5F);
}

}  // namespace
}  // namespace ossa::depth
