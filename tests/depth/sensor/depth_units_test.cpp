#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "depth/base/error.h"
#include "depth/image/depth_png.h"
#include "depth/sensor/body_bulge.h"
#include "depth/sensor/depth_census.h"
#include "depth/sensor/depth_coding.h"
#include "depth/sensor/frame_source.h"
#include "tests/support/capsule_person.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

// A person in a room, with typical sensor holes.
const DepthFrame& RoomFrame() {
  static const DepthFrame frame = [] {
    tests::CapsuleScene scene;
    scene.people.push_back({});
    scene.planes = tests::EmptyRoom();
    scene.noise_m = 0.002;
    DepthFrame made = tests::Render(scene, KinectV1Camera(160, 120)).frame;
    for (size_t i = 0; i < made.depth_mm.size(); i += 37) made.depth_mm[i] = 0;
    return made;
  }();
  return frame;
}

using Change = std::function<int(int)>;

DepthFrame Changed(const Change& change) {
  DepthFrame frame = RoomFrame();
  for (uint16_t& depth : frame.depth_mm) depth = static_cast<uint16_t>(change(depth));
  return frame;
}

std::optional<DepthSuspicion> Judged(const DepthFrame& frame) {
  DepthCensus census;
  census.Add(frame.view());
  return census.Judge();
}

int KinectShift(int mm) {  // Burrus's fit, not the table that reads it
  return mm == 0 ? 2047 : static_cast<int>((3.3309495161 - 1000.0 / mm) / 0.0030711016);
}

struct Case {
  const char* what;
  Change change;
  const char* option;
  double off_mm;  // tolerance of converted distances
};

class DepthsOfOtherKinds : public testing::TestWithParam<Case> {};

TEST_P(DepthsOfOtherKinds, AreRefusedAndTheNamedOptionReadsThem) {
  const auto suspicion = Judged(Changed(GetParam().change));
  ASSERT_TRUE(suspicion.has_value());
  EXPECT_EQ(suspicion->option, GetParam().option);
  const std::string option = suspicion->option;
  const std::string value = option.substr(option.find(' ') + 1);
  DepthCoding coding;
  if (option.starts_with("--depth-scale")) coding.units_per_metre = std::stod(value);
  if (option.starts_with("--depth-format")) coding = ParseDepthFormat(value);
  const auto table = MillimetreTable(coding);
  for (const int mm : {1000, 2000, 3500}) {
    EXPECT_NEAR(table[static_cast<size_t>(GetParam().change(mm))], mm, GetParam().off_mm);
  }
  EXPECT_EQ(table[static_cast<size_t>(GetParam().change(0))], 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, DepthsOfOtherKinds,
    testing::Values(
        Case{"quarters", [](int mm) { return mm * 4; }, "--depth-scale 4000", 0},
        Case{"fifths", [](int mm) { return mm * 5; }, "--depth-scale 5000", 0},
        Case{"eighths", [](int mm) { return mm * 8; }, "--depth-scale 8000", 0},
        Case{"player_bits", [](int mm) { return mm << 3 | (mm > 0 && mm < 3100 ? 2 : 0); },
             "--depth-scale 8000", 0.5},
        Case{"tenths", [](int mm) { return mm * 10; }, "--depth-scale 10000", 0},
        Case{"centimetres", [](int mm) { return mm / 10; }, "--depth-scale 100", 10},
        Case{"disparity", KinectShift, "--depth-format disparity", 60},
        Case{"swapped", [](int mm) { return (mm & 255) << 8 | mm >> 8; }, "--depth-format swapped",
             0},
        Case{"inverted", [](int mm) { return 65535 - mm; }, "--depth-format inverted", 0}),
    [](const auto& info) { return std::string(info.param.what); });

TEST(DepthCensus, DoesNotSuspectMillimetres) { EXPECT_FALSE(Judged(RoomFrame()).has_value()); }

// As written by a renderer without a background.
TEST(DepthCensus, DoesNotTakeASaturatedBackgroundForInvertedDepths) {
  for (const int farthest_mm : {2600, 4200, 6000}) {
    const auto suspicion = Judged(Changed([&](int mm) { return mm < farthest_mm ? mm : 65535; }));
    EXPECT_FALSE(suspicion) << suspicion->looks;
  }
}

TEST(DepthCoding, SaturatedValuesAreNoReading) {
  for (const double units_per_metre : {1000.0, 4000.0, 10000.0}) {
    const auto table = MillimetreTable({.units_per_metre = units_per_metre});
    EXPECT_EQ(table[65535], 0) << units_per_metre;
    EXPECT_EQ(table[4000], static_cast<uint16_t>(4e6 / units_per_metre));
  }
}

TEST(DepthCensus, RecognisesDisparitiesWithoutHoles) {
  const auto suspicion = Judged(Changed([](int mm) { return KinectShift(mm == 0 ? 3000 : mm); }));
  ASSERT_TRUE(suspicion.has_value());
  EXPECT_EQ(suspicion->option, "--depth-format disparity");
}

TEST(DepthCensus, RefusesImpossibleDepthsWithoutSuggestingAnOption) {
  const auto suspicion = Judged(Changed([](int mm) { return mm > 3000 ? 40 : mm; }));
  ASSERT_TRUE(suspicion.has_value());
  EXPECT_EQ(suspicion->option, "");
}

// A depth camera on a table sees its top, some centimetres before the lens.
TEST(DepthCensus, DoesNotSuspectATableRightBeforeTheCamera) {
  DepthFrame frame = RoomFrame();
  const size_t table = frame.depth_mm.size() / 10;
  for (size_t i = frame.depth_mm.size() - table; i < frame.depth_mm.size(); ++i)
    frame.depth_mm[i] = static_cast<uint16_t>(60 + i % 30);
  const auto suspicion = Judged(frame);
  EXPECT_FALSE(suspicion) << suspicion->looks;
}

// As in data sets of Kinect v2 depths that use all 16 bits for 4.5 m.
TEST(DepthCensus, RefusesDepthsStretchedTo16Bits) {
  const auto suspicion = Judged(Changed([](int mm) { return std::min(mm * 65535 / 4500, 65535); }));
  ASSERT_TRUE(suspicion.has_value());
  EXPECT_NE(suspicion->looks.find("stretched"), std::string::npos) << suspicion->looks;
}

TEST(DepthCensus, DoesNotSuspectALargeBackgroundValue) {
  const auto suspicion = Judged(Changed([](int mm) { return mm < 3000 ? mm : 60000; }));
  EXPECT_FALSE(suspicion) << suspicion->looks;
}

TEST(DepthCensus, DoesNotDecideFromTooFewPixels) {
  DepthFrame frame = Changed([](int mm) { return mm / 10; });
  frame.depth_mm.resize(160 * 2);
  frame.camera.height = 2;
  EXPECT_FALSE(Judged(frame).has_value());
}

// A level camera at 1 m, with a wall 3 m away, sees less floor than a window: the curvature comes
// from the corner.
TEST(DepthCensus, DoesNotSuspectTheCornerOfAnEmptyRoom) {
  for (const double noise_m : {0.0, 0.0005}) {
    for (const double wall_m : {2.6, 2.8, 3.0, 3.2}) {
      tests::CapsuleScene scene;
      scene.planes = {{{0.0, 1.0, 0.0}, 1.0}, {{0.0, 0.0, -1.0}, wall_m}};
      scene.noise_m = noise_m;
      const DepthFrame room = tests::Render(scene, KinectV1Camera(640, 480)).frame;
      const auto suspicion = Judged(room);
      EXPECT_FALSE(suspicion) << wall_m << " m, noise " << noise_m << ": " << suspicion->looks;
    }
  }
}

// Noise-free, as from a simulator: values change along rows only at the edges of a box.
TEST(DepthCensus, DoesNotSuspectPlayerBitsInARenderedRoomWithABox) {
  tests::CapsuleScene scene;
  scene.planes = {{{0.0, 1.0, 0.0}, 1.0}, {{0.0, 0.0, -1.0}, 3.0}};
  scene.boxes = {{{-0.4, -0.2, 2.0}, {0.4, 0.5, 2.2}}};
  const auto suspicion = Judged(tests::Render(scene, KinectV1Camera(640, 480)).frame);
  EXPECT_FALSE(suspicion) << suspicion->looks;
}

// A room from one viewpoint, noise-free or with the noise of a Kinect v1, 1.5 mm at a metre.
struct Place {
  double height_m, wall_m, tilt_rad, noise_m;
};

DepthFrame RoomFrom(const Place& place) {
  tests::CapsuleScene scene;
  const Eigen::Vector3d up(0.0, std::cos(place.tilt_rad), -std::sin(place.tilt_rad));
  const Eigen::Vector3d forward(0.0, std::sin(place.tilt_rad), std::cos(place.tilt_rad));
  scene.planes = {{up, place.height_m}, {-forward, place.wall_m}};
  scene.people.push_back({});
  scene.people[0].feet_m = 0.7 * place.wall_m * forward - place.height_m * up;
  scene.noise_m = place.noise_m;
  return tests::Render(scene, KinectV1Camera(160, 120)).frame;
}

std::pair<int, int> NearestAndFarthest(const DepthFrame& frame) {
  int least = 65535, most = 0;
  for (const int depth : frame.depth_mm) {
    if (depth > 0) least = std::min(least, depth);
    most = std::max(most, depth);
  }
  return {least, most};
}

// Inverts distances: subtracts each from this value.
DepthFrame TakenFrom(DepthFrame frame, int from_mm) {
  for (uint16_t& depth : frame.depth_mm) {
    if (depth > 0) depth = static_cast<uint16_t>(from_mm - depth);
  }
  return frame;
}

class TurnedRound : public testing::TestWithParam<Place> {};

TEST_P(TurnedRound, InvertedRoomIsRecognisedByItsFloor) {
  const DepthFrame room = RoomFrom(GetParam());
  EXPECT_FALSE(Judged(room).has_value());
  const auto [least, most] = NearestAndFarthest(room);
  for (const int from_mm : {most, most + least, most + 1000}) {
    const auto suspicion = Judged(TakenFrom(room, from_mm));
    ASSERT_TRUE(suspicion.has_value()) << from_mm;
    EXPECT_EQ(suspicion->option, "--depth-format inverted:FROM");
  }
}

INSTANTIATE_TEST_SUITE_P(FromPlaces, TurnedRound,
                         testing::Values(Place{1.0, 4.5, 0.0, 0.0}, Place{1.0, 4.5, 0.0, 0.0015},
                                         Place{0.7, 4.0, 0.0, 0.0015}, Place{1.5, 5.0, 0.2, 0.0015},
                                         Place{2.0, 5.0, 0.4, 0.0}, Place{2.0, 5.0, 0.4, 0.0015},
                                         Place{1.2, 6.0, -0.05, 0.001},
                                         Place{1.2, 3.5, 0.1, 0.0015}, Place{2.4, 6.0, 0.5, 0.001},
                                         Place{1.8, 3.0, 0.6, 0.001}, Place{1.0, 7.0, 0.1, 0.0},
                                         Place{0.9, 5.5, 0.0, 0.001}));

// A person without a visible floor: cut out, or in front of a frontal wall.
struct Person {
  double away_m, noise_m;
  int width;
  bool wall;
};

DepthFrame PersonFrom(const Person& person) {
  tests::CapsuleScene scene;
  scene.people.push_back({});
  scene.people[0].feet_m = {0.0, -1.0, person.away_m};
  if (person.wall) scene.planes = {{-Eigen::Vector3d::UnitZ(), person.away_m + 0.7}};
  scene.noise_m = person.noise_m;
  return tests::Render(scene, KinectV1Camera(person.width, person.width * 3 / 4)).frame;
}

class WithoutAFloor : public testing::TestWithParam<Person> {};

TEST_P(WithoutAFloor, InvertedPersonIsRecognisedByTheBodysCurvature) {
  const DepthFrame person = PersonFrom(GetParam());
  EXPECT_FALSE(Judged(person).has_value());
  const auto [least, most] = NearestAndFarthest(person);
  for (const int from_mm : {most, most + least, 8000}) {
    const auto suspicion = Judged(TakenFrom(person, from_mm));
    ASSERT_TRUE(suspicion.has_value()) << from_mm;
    EXPECT_EQ(suspicion->option, "--depth-format inverted:FROM") << from_mm;
  }
}

TEST_P(WithoutAFloor, CentimetresAreNotTakenForInvertedDepths) {
  DepthFrame person = PersonFrom(GetParam());
  for (uint16_t& depth : person.depth_mm) depth = static_cast<uint16_t>((depth + 5) / 10);
  const auto suspicion = Judged(person);
  ASSERT_TRUE(suspicion.has_value());
  EXPECT_EQ(suspicion->option, "--depth-scale 100");
}

INSTANTIATE_TEST_SUITE_P(
    Somebody, WithoutAFloor,
    testing::Values(Person{2.5, 0.0, 320, false}, Person{2.5, 0.0015, 320, false},
                    Person{3.0, 0.0015, 320, false}, Person{1.5, 0.0015, 160, false},
                    Person{2.5, 0.0, 160, false}, Person{2.5, 0.0015, 320, true},
                    Person{3.0, 0.0, 160, true}));

TEST(DepthCensus, RecognisesPlayerBitsOfTwoCutOutPeople) {
  DepthFrame person = PersonFrom({2.5, 0.0015, 320, false});
  for (size_t i = 0; i < person.depth_mm.size(); ++i) {
    uint16_t& depth = person.depth_mm[i];  // a player left and another right of the middle
    if (depth > 0) depth = static_cast<uint16_t>(depth << 3 | (i % 320 < 160 ? 1 : 6));
  }
  const auto suspicion = Judged(person);
  ASSERT_TRUE(suspicion.has_value());
  EXPECT_EQ(suspicion->option, "--depth-scale 8000");
}

// The depth of an upright cylinder of 10 cm radius at 2 m, or of its hollow mould.
DepthFrame Cylinder(bool is_groove) {
  DepthFrame frame;
  frame.camera = KinectV1Camera(160, 120);
  frame.depth_mm.assign(160 * 120, 0);
  constexpr int kRadius = 7;  // pixels
  for (int v = 20; v < 100; ++v) {
    for (int u = 80 - kRadius; u <= 80 + kRadius; ++u) {
      const double across = (u - 80.0) / (kRadius + 0.5);
      const double bulge_mm = 100.0 * std::sqrt(1.0 - across * across);
      frame.depth_mm[static_cast<size_t>(v * 160 + u)] =
          static_cast<uint16_t>(is_groove ? 1900.0 + bulge_mm : 2000.0 - bulge_mm);
    }
  }
  return frame;
}

TEST(BodyBulge, CylinderIsConvexAndItsMouldConcave) {
  BodyBulge cylinder, mould;
  cylinder.Add(Cylinder(false).view());
  mould.Add(Cylinder(true).view());
  EXPECT_TRUE(cylinder.IsRound() && !cylinder.IsHollow());
  EXPECT_TRUE(mould.IsHollow() && !mould.IsRound());
}

TEST(BodyBulge, FlatBoardIsNeitherConvexNorConcave) {
  DepthFrame board = Cylinder(false);
  for (uint16_t& depth : board.depth_mm) depth = static_cast<uint16_t>(depth > 0 ? 2000 : 0);
  BodyBulge bulge;
  bulge.Add(board.view());
  EXPECT_FALSE(bulge.IsRound() || bulge.IsHollow() || bulge.IsEnough());
}

// As for a distant stationary person: the same accidental stretch in every image.
TEST(BodyBulge, OneConcaveRunPerImageIsNoEvidence) {
  const DepthFrame mould = Cylinder(true);
  DepthFrame board = mould;
  for (uint16_t& depth : board.depth_mm) depth = static_cast<uint16_t>(depth > 0 ? 2000 : 0);
  constexpr size_t kRow = size_t{60} * 160;
  std::copy_n(&mould.depth_mm[kRow], 160, &board.depth_mm[kRow]);
  BodyBulge bulge;
  for (int image = 0; image < 30; ++image) bulge.Add(board.view());
  EXPECT_FALSE(bulge.IsHollow());
}

// As for a person entering the image: at first only a hollow edge of a sleeve is visible.
TEST(DepthCensus, DoesNotSuspectAConcaveObjectInAConsistentRoom) {
  tests::CapsuleScene scene;
  scene.planes = {{Eigen::Vector3d::UnitY(), 1.2}};
  DepthFrame room = tests::Render(scene, KinectV1Camera(160, 120)).frame;
  const DepthFrame groove = Cylinder(true);
  for (size_t i = 0; i < room.depth_mm.size(); ++i) {
    const bool is_shadow = i % 160 > 55 && i % 160 < 105;
    if (groove.depth_mm[i] > 0 || is_shadow) room.depth_mm[i] = groove.depth_mm[i];
  }
  BodyBulge bulge;
  bulge.Add(room.view());
  ASSERT_TRUE(bulge.IsHollow());
  EXPECT_FALSE(Judged(room).has_value());
}

// Three times as large, and of each pixel the mean over 5 x 5, holes as 0.
DepthFrame EnlargedAndSmoothed(const DepthFrame& frame) {
  constexpr int kReach = 2, kPixels = 25, kTimes = 3;
  DepthFrame large;
  large.camera = KinectV1Camera(kTimes * frame.camera.width, kTimes * frame.camera.height);
  for (int v = 0; v < large.camera.height; ++v) {
    for (int u = 0; u < large.camera.width; ++u)
      large.depth_mm.push_back(frame.view().at(u / kTimes, v / kTimes));
  }
  DepthFrame smooth = large;
  const DepthView image = large.view();
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      int sum_mm = 0;
      for (int i = 0; i < kPixels; ++i) {
        const int x = u + i % 5 - kReach, y = v + i / 5 - kReach;
        if (x >= 0 && y >= 0 && x < image.width && y < image.height) sum_mm += image.at(x, y);
      }
      smooth.depth_mm[static_cast<size_t>(v * image.width + u)] =
          static_cast<uint16_t>(sum_mm / kPixels);
    }
  }
  return smooth;
}

// Three frames of a golden clip with its users alone, changed, in a folder.
template <typename Change>
void WriteCutOuts(const std::string& clip, const std::filesystem::path& folder,
                  const Change& change) {
  const auto clips = test::SourceFolder() / "tests/golden/clips";
  const auto source = OpenSource((clips / clip).string());
  for (int i = 0; i < 3; ++i) {
    DepthFrame frame = source->Read(std::chrono::seconds(1)).frame;
    const std::string name = "00000" + std::to_string(i) + ".png";
    const auto users = ReadLabelPng(clips / clip / "users" / name);
    for (size_t k = 0; k < frame.depth_mm.size(); ++k) {
      if (users.data[k] == 0) frame.depth_mm[k] = 0;
    }
    WriteDepthPng(folder / name, change(frame).view());
  }
}

TEST(DepthUnits, RefusesInvertedCutOutsOfRenderedPeople) {
  for (const char* clip : {"one", "two"}) {
    const test::TemporaryFolder folder;
    WriteCutOuts(clip, folder.path(), [](const DepthFrame& frame) {
      return TakenFrom(frame, NearestAndFarthest(frame).second);
    });
    test::ExpectRefused([&] { OpenSource(folder.path().string()); }, "inverted:FROM reads them");
  }
}

// Programs that align depth to larger colour images smooth it. With holes as 0 this bends surfaces
// at their edges as if they were inverted.
TEST(DepthUnits, TakesSmoothedCutOutsOfRenderedPeople) {
  for (const char* clip : {"one", "two"}) {
    const test::TemporaryFolder folder;
    WriteCutOuts(clip, folder.path(), EnlargedAndSmoothed);
    EXPECT_NO_THROW(OpenSource(folder.path().string())) << clip;
  }
}

TEST(DepthUnits, RefusesInvertedRenderedClips) {
  for (const char* clip : {"one", "two"}) {
    const test::TemporaryFolder folder;
    const auto source = OpenSource((test::SourceFolder() / "tests/golden/clips" / clip).string());
    for (int i = 0; i < 3; ++i) {
      const DepthFrame frame = source->Read(std::chrono::seconds(1)).frame;
      const auto [least, most] = NearestAndFarthest(frame);
      WriteDepthPng(folder / (std::to_string(i) + ".png"), TakenFrom(frame, most + least).view());
    }
    test::ExpectRefused([&] { OpenSource(folder.path().string()); }, "bend the wrong way");
  }
}

TEST(DepthCoding, InvertsFromAnyMaximum) {
  const auto table = MillimetreTable(ParseDepthFormat("inverted:8000"));
  EXPECT_EQ(table[8000 - 2500], 2500);
  EXPECT_EQ(table[0], 0);     // no reading,
  EXPECT_EQ(table[8000], 0);  // ... no distance,
  EXPECT_EQ(table[9000], 0);  // ... behind the camera
}

TEST(DepthCoding, UnknownFormatsAreRefused) {
  for (const char* name : {"inverted:", "inverted:0", "inverted:65536", "inverted:1x", "upside"}) {
    test::ExpectRefused([&] { ParseDepthFormat(name); }, std::string("found '") + name + "'");
  }
}

TEST(DepthUnits, RefusesSuspectDepthsAndNamesTheOption) {
  const test::TemporaryFolder folder;
  const DepthFrame centimetres = Changed([](int mm) { return mm / 10; });
  WriteDepthPng(folder / "0.png", centimetres.view());
  const std::string name = folder.path().string();
  test::ExpectRefused([&] { OpenSource(name); }, "centimetres");
  test::ExpectRefused([&] { OpenSource(name); }, "--depth-scale 100 reads them so");
  const auto read = OpenSource(name, {.depth_scale = 100.0})->Read(std::chrono::milliseconds(1));
  EXPECT_EQ(read.frame.depth_mm[5000], centimetres.depth_mm[5000] * 10);
  const auto raw = OpenSource(name, {.depth_scale = 1000.0})->Read(std::chrono::milliseconds(1));
  EXPECT_EQ(raw.frame.depth_mm[5000], centimetres.depth_mm[5000]);
}

// Quarters of a millimetre as a sensor gives them, with all remainders: some cameras see as far.
TEST(DepthUnits, WarnsOfDepthsBeyondPeople) {
  const test::TemporaryFolder folder;
  int number = 0;
  const DepthFrame quarters = Changed([&](int mm) { return mm == 0 ? 0 : 4 * mm + number++ % 4; });
  WriteDepthPng(folder / "0.png", quarters.view());
  std::vector<std::string> warnings;
  SourceOptions options;
  options.note = [&](NoteKind kind, const std::string& text) {
    if (kind == NoteKind::kWarning) warnings.push_back(text);
  };
  OpenSource(folder.path().string(), options);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("fifths of a millimetre (Orbbec), --depth-scale 5000"),
            std::string::npos)
      << warnings[0];
  options.depth_scale = 4000;
  OpenSource(folder.path().string(), options);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST(DepthUnits, DoesNotSuspectRealSensors) {
  const auto real = test::SharedFolder() / "real";
  if (!std::filesystem::is_directory(real)) GTEST_SKIP() << "not here: " << real;
  for (const char* name :
       {"depth_frames/skeltrack_v1", "depth_frames/pcl_person", "depth_frames/pcl_five_people",
        "itop_depth/side", "itop_depth/top", "kinect_v1_seated_video/depth"}) {
    for (const auto& entry : std::filesystem::directory_iterator(real / name)) {
      if (entry.path().extension() != ".png") continue;
      EXPECT_NO_THROW(OpenSource(entry.path().string())) << entry.path();
    }
  }
}

}  // namespace
}  // namespace ossa::depth
