// The geometry of a frame: floor, flat pieces, furniture, and changes of the scene.
#include "depth/scene/measure_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "depth/scene/planes.h"
#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

// Cells cover about the same angle in images of any size, so that people have equally many.
TEST(PointGrid, HasSimilarSizeForAnyImage) {
  for (int width = 120; width <= 1920; ++width) {
    const int cells = width / CellPixels(width);
    EXPECT_GE(cells, 106) << width;
    EXPECT_LE(cells, 239) << width;
  }
  EXPECT_EQ(CellPixels(320), 2);
  EXPECT_EQ(CellPixels(474), 3);
  EXPECT_EQ(CellPixels(640), 4);
}

// The lowest strip of the wall is within a Kinect's error of the floor, but does not run along it:
// only the rounding to millimetres remains.
TEST(FindFloor, FindsTheFloorOfAnEmptyRoom) {
  FloorState state;
  const auto floor = FindFloor(GridOf(Shot({PersonAt(0, 2.5)})), state);
  ASSERT_TRUE(floor.has_value());
  EXPECT_NEAR(floor->coefficients[3], 1.0, 0.001);
  EXPECT_GT(floor->coefficients[1], std::cos(0.002));
}

// A level sensor of 46 degrees, 1.3 m over the floor: 15 of 100 rows below the wall show it.
TEST(FindFloor, IsAStripAtTheLowerBorder) {
  constexpr Camera kNarrow{.width = 100, .height = 100, .fx = 119, .fy = 119, .cx = 50, .cy = 50};
  CapsuleScene scene;
  scene.planes = {{{0, 0, -1}, 4.5}, {{0, 1, 0}, 1.3}};
  const PointGrid grid = GridOf(tests::Render(scene, kNarrow));
  int found = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    FloorState state;
    const auto floor = FindFloor(grid, state, {.seed = seed});
    found += floor && std::abs(floor->coefficients[3] - 1.3) < 0.1;
  }
  // All. By the number of measurements within the tolerance alone, 11: else askew planes won.
  EXPECT_GE(found, 18);
}

// The frame before was taken for a plane that leans against the wall: at the corner it has
// measurements on both sides, more within the tolerance than the strip of floor has, but some
// below.
TEST(FindFloor, IgnoresObliquePlanesBetweenFloorAndWall) {
  struct Row {
    double tilt_rad, askew_m, wall_m, floor_m;
  };
  constexpr Row kRows[] = {{0.45, 2.7, 4.5, 1.2},
                           {0.5, 2.9, 4.3, 1.3},
                           {0.55, 3.1, 4.5, 1.3},
                           {0.6, 3.0, 4.1, 1.2},
                           {0.65, 3.3, 4.3, 1.3}};
  constexpr Camera kNarrow{.width = 100, .height = 100, .fx = 119, .fy = 119, .cx = 50, .cy = 50};
  for (const Row& row : kRows) {
    CapsuleScene scene;
    scene.planes = {{{0, 0, -1}, row.wall_m}, {{0, 1, 0}, row.floor_m}};
    FloorState state;
    state.plane = FloorPlane{{0, std::cos(row.tilt_rad), -std::sin(row.tilt_rad), row.askew_m}};
    const auto floor = FindFloor(GridOf(tests::Render(scene, kNarrow)), state);
    ASSERT_TRUE(floor) << row.askew_m << " " << row.wall_m;
    EXPECT_NEAR(floor->coefficients[3], row.floor_m, 0.001) << row.askew_m << " " << row.wall_m;
    EXPECT_GT(floor->coefficients[1], std::cos(0.001)) << row.askew_m << " " << row.wall_m;
  }
}

// A grid seen from this height over the floor.
PointGrid OverTheFloor(double height_m) {
  CapsuleScene scene;
  scene.planes = {{{0, 1, 0}, height_m}, {{0, 0, -1}, 4.5}};
  return GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
}

TEST(FindFloor, IsSteadyUntilTheSensorIsMoved) {
  const auto height_m = [](double true_m, FloorState& state) {
    const auto floor = FindFloor(OverTheFloor(true_m), state);
    return floor ? floor->coefficients[3] : 0.0;
  };
  FloorState state, alone;
  const double first_m = height_m(1.0, state);
  EXPECT_NEAR(height_m(1.04, state) - first_m, 0.25 * 0.04, 0.004);  // FloorOptions::smoothing
  const double lifted_m = height_m(1.4, state);
  EXPECT_GT(lifted_m, 1.3);
  EXPECT_EQ(lifted_m, height_m(1.4, alone));
}

// 5 degrees: a knock against a tripod. A mean with the floor before would lie above a part of this
// one.
TEST(FindFloor, FollowsATiltedSensorAtOnce) {
  for (const double tilt_rad : {-0.087, 0.087}) {
    const Eigen::Vector3d up(0, std::cos(tilt_rad), -std::sin(tilt_rad));
    CapsuleScene scene;
    scene.planes = {{up, 1.0}, {{0, 0, -1}, 4.5}};
    FloorState state;
    for (int f = 0; f < 3; ++f) FindFloor(OverTheFloor(1.0), state);
    const auto floor = FindFloor(GridOf(tests::Render(scene, KinectV1Camera(320, 240))), state);
    ASSERT_TRUE(floor) << tilt_rad;
    EXPECT_LT((floor->coefficients.head<3>() - up).norm(), 0.005) << tilt_rad;  // quantisation
  }
}

TEST(FindFloor, IsRememberedForHalfASecondOutOfView) {
  FloorState state;
  FindFloor(OverTheFloor(1.0), state);
  CapsuleScene wall;
  wall.planes = {{{0, 0, -1}, 2.0}};
  const PointGrid without = GridOf(tests::Render(wall, KinectV1Camera(320, 240)));
  for (int frame = 1; frame <= 16; ++frame) {
    EXPECT_FALSE(FindFloor(without, state));
    EXPECT_EQ(state.plane.has_value(), frame <= 15) << frame;
  }
}

TEST(FindFloor, WallAloneGivesNoFloor) {
  CapsuleScene scene;
  scene.planes = {{{0, 0, -1}, 2.0}};
  FloorState state;
  EXPECT_FALSE(FindFloor(GridOf(tests::Render(scene, KinectV1Camera(320, 240))), state));
}

TEST(FlatPieces, FindTheWallWithItsNormalAndArea) {
  CapsuleScene scene;
  scene.planes = {{{0, 0, -1}, 3.0}};
  const PointGrid grid = GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
  const auto pieces = FlatPieces(grid, std::vector<uint8_t>(static_cast<size_t>(grid.cells()), 0),
                                 FurnitureOptions{}.person_m2);
  ASSERT_FALSE(pieces.empty());
  EXPECT_LT(pieces[0].normal.z(), -0.999);
  // The image shows 320 / 287.5 x 240 / 287.5 of the distance: 8.36 m2 at 3 m. Cells towards the
  // corners are counted a little larger than they are: they lie slanted to their line of sight.
  EXPECT_NEAR(pieces[0].area_m2, 8.36, 0.08 * 8.36);
}

TEST(FindRoomSurfaces, IncludeTheRoomButNotThePerson) {
  const CapsuleRender render = Shot({PersonAt(0, 1.8)});
  const PointGrid grid = GridOf(render);
  FloorState state;
  const RoomShape shape = FindRoomSurfaces(grid, FindFloor(grid, state));
  int person = 0, taken = 0, room = 0, left = 0;
  for (int cell = 0; cell < grid.cells(); ++cell) {
    if (!grid.valid(cell)) continue;
    const bool mine =
        render.person.at(cell % grid.width * grid.step, cell / grid.width * grid.step) > 0;
    const bool gone = shape.room[static_cast<size_t>(cell)] != 0;
    (mine ? person : room) += 1;
    taken += mine && gone ? 1 : 0;
    left += !mine && !gone ? 1 : 0;
  }
  EXPECT_LT(taken, 0.05 * person);  // soles
  EXPECT_LT(left, 0.05 * room);     // edges, where nothing is flat
}

// Share of a box's pixels that are taken for the room.
double RoomShare(const CapsuleRender& with, const CapsuleRender& without) {
  const PointGrid grid = GridOf(with), before = GridOf(without);
  FloorState state;
  const RoomShape shape = FindRoomSurfaces(grid, FindFloor(grid, state));
  double box = 0, room = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i) || std::abs(grid.z(i) - before.z(i)) < 0.05F) continue;
    box += 1;
    room += shape.room[static_cast<size_t>(i)] != 0 ? 1 : 0;
  }
  return room / box;
}

// A chest's plane goes on in a strip of a curtain that crosses it a hand's breadth from the arm:
// together they are larger than a person.
TEST(FindRoomSurfaces, PersonBesideACurtainIsNotAWall) {
  CapsuleScene without;
  without.planes = tests::EmptyRoom();
  without.planes.push_back({Eigen::Vector3d(-2.5, 0, -1).normalized(), 5.65 / std::sqrt(7.25)});
  CapsuleScene with = without;
  with.boxes = {{{0.08, -0.65, 4.15}, {0.53, 0.65, 4.2}}};
  const auto camera = KinectV1Camera(320, 240);
  EXPECT_LT(RoomShare(tests::Render(with, camera), tests::Render(without, camera)), 0.1);
}

TEST(FindRoomSurfaces, RecogniseASofaFrontDividedByLegs) {
  // 1.6 m wide and 0.42 m high, 30 cm behind the feet: each half has the area of a person's side.
  const std::vector<CapsulePose> people = {PersonAt(0, 2.4)};
  const std::vector<tests::Box> sofa = {{{-0.8, -1.0, 2.7}, {0.8, -0.58, 3.3}}};
  // Cells at edges see half the box and half what is behind.
  EXPECT_GT(RoomShare(Shot(people, 0, sofa), Shot(people)), 0.8);
}

// Share of a table top's cells that are recognised, as seen by a Kinect 12 cm above it: few rows of
// cells, whose depth noise of centimetres prevents a plane fit, while their height varies by about
// 3 mm.
double TopShare(double half_width_m, double near_m, double far_m) {
  constexpr double kTop_m = -0.12, kEdge_m = 0.05;
  CapsuleScene scene;
  scene.people = {PersonAt(0.9, 3.2)};
  scene.planes = tests::EmptyRoom();
  scene.boxes = {{{-half_width_m, kTop_m - 0.04, near_m}, {half_width_m, kTop_m, far_m}}};
  scene.noise_m = 0.005;
  const PointGrid grid = GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
  FloorState state;
  const RoomShape shape = FindRoomSurfaces(grid, FindFloor(grid, state));
  double top = 0, room = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    const Eigen::Vector3d p = grid.at(i).cast<double>();
    if (p.z() < near_m + 2.0 * kEdge_m || p.z() > far_m - 2.0 * kEdge_m) continue;
    if (std::abs(p.x()) > half_width_m - kEdge_m || std::abs(p.y() - kTop_m) > 0.01) continue;
    top += 1;
    room += shape.room[static_cast<size_t>(i)] != 0 ? 1 : 0;
  }
  EXPECT_GT(top, 50);
  return room / top;
}

TEST(FindRoomSurfaces, RecogniseATableSeenFromItsOwnHeight) {
  EXPECT_GT(TopShare(0.6, 1.4, 2.8), 0.95);
}

TEST(FindRoomSurfaces, LapIsNotATable) {
  EXPECT_LT(TopShare(0.1, 0.9, 2.9), 0.1);  // larger than the smallest table
}

// Detection of scene changes between frames.
class SceneOverTime : public testing::Test {
 protected:
  Scene Measure(const CapsuleRender& render) { return MeasureScene(render.frame, state_); }
  SceneState state_;
};

TEST_F(SceneOverTime, IsFreshAtFirstAndAfterAGap) {
  EXPECT_TRUE(Measure(Shot({PersonAt(0, 2.5)}, 0)).fresh);
  EXPECT_FALSE(Measure(Shot({PersonAt(0, 2.5)}, 1)).fresh);
  EXPECT_TRUE(Measure(Shot({PersonAt(0, 2.5)}, 40)).fresh);
}

TEST_F(SceneOverTime, IsFreshInAnotherRecordingButNotAfterClockJitter) {
  CapsuleRender render = Shot({PersonAt(0, 2.5)}, 30);
  Measure(render);
  render.frame.time_s -= 0.004;
  EXPECT_FALSE(Measure(render).fresh);
  render.frame.time_s -= 0.006;
  EXPECT_TRUE(Measure(render).fresh);
}

TEST_F(SceneOverTime, ChangesIfMostCellsDifferOrTheImageSizeChanges) {
  EXPECT_TRUE(Measure(Shot({PersonAt(0, 2.5)}, 0)).changed);
  EXPECT_FALSE(Measure(Shot({PersonAt(0.3, 2.5)}, 1)).changed);
  CapsuleScene other;
  other.planes = {{{0, 1, 0}, 1.0}, {{0, 0, -1}, 3.4}};  // the wall is a metre nearer
  CapsuleRender render = tests::Render(other, KinectV1Camera(320, 240));
  render.frame.time_s = 2 / 30.0;
  const Scene another = Measure(render);
  EXPECT_TRUE(another.changed);
  EXPECT_TRUE(another.fresh);
  render = tests::Render(other, KinectV1Camera(160, 120));
  render.frame.time_s = 3 / 30.0;
  EXPECT_TRUE(Measure(render).changed);
}

}  // namespace
}  // namespace ossa::depth
