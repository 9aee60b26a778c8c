// Scene files: what they say, and what is wrong with them in one line.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <string>

#include "depth/base/error.h"
#include "tests/support/temporary_folder.h"
#include "tools/tracker/scene.h"

namespace ossa::tracker {
namespace {

SceneOptions Load(const std::string& text) {
  const ossa::test::TemporaryFolder folder;
  const std::string path = folder / "scene.toml";
  std::ofstream(path) << text;
  return LoadScene(path);
}

constexpr const char* kScene = R"(# a scene
floor = [0, 1, 0, 1.2]
[[object]]
name = "dumbbell"
shape = "capsule"
size_m = [0.03, 0.2]
mass_kg = 2.5
friction = 0.9
bounce = 0.1
at_m = [0.1, 0.8, 2]
turn_deg = [0, 0, 90]
from = "person"
person = 2
after_s = 1.5
[[object.part]]
shape = "ball"
size_m = 0.1
at_m = [0, 0.1, 0]
[[object]]
name = "table"
size_m = [1, 0.7, 0.5]
at_m = [0, 0.35, 2.5]
static = true
[[grab]]
objects = ["dumbbell"]
joints = ["HandLeft", "WristRight"]
hands = 2
people = 2
near_m = 0.08
shared_torque_nm = 2
[[release]]
away_m = 0.3
[[throw]]
faster_m_s = 3
[dodge]
cover = false
)";

TEST(SceneFile, ReadsObjects) {
  const SceneOptions scene = Load(kScene);
  ASSERT_EQ(scene.objects.size(), 2U);
  const SceneObject& dumbbell = scene.objects[0];
  EXPECT_EQ(dumbbell.body.shape, physics::Shape::kCapsule);
  EXPECT_EQ(dumbbell.body.size_m, Eigen::Vector3d(0.03, 0.2, 0.03));
  EXPECT_EQ(dumbbell.body.mass_kg, 2.5);
  EXPECT_EQ(dumbbell.origin, SceneObject::Origin::kPerson);
  EXPECT_EQ(dumbbell.person, 2);
  EXPECT_EQ(dumbbell.after_s, 1.5);
  const Eigen::Vector3d along = dumbbell.body.orientation * Eigen::Vector3d::UnitY();
  EXPECT_LT((along - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-9);
  ASSERT_EQ(dumbbell.body.parts.size(), 1U);
  EXPECT_EQ(dumbbell.body.parts[0].position_m.y(), 0.1);
  EXPECT_EQ(scene.objects[1].body.kind, physics::BodyKind::kStatic);
  EXPECT_NO_THROW(scene.Check());
}

TEST(SceneFile, ReadsRulesAndFloor) {
  const SceneOptions scene = Load(kScene);
  ASSERT_EQ(scene.grabs.size(), 1U);
  EXPECT_EQ(scene.grabs[0].joints,
            (std::vector{recon::Joint::kHandLeft, recon::Joint::kWristRight}));
  EXPECT_EQ(scene.grabs[0].people, 2);
  EXPECT_EQ(scene.grabs[0].shared_torque_nm, 2.0);
  EXPECT_EQ(scene.releases.at(0).away_m, 0.3);
  EXPECT_EQ(scene.throws.at(0).faster_m_s, 3.0);
  ASSERT_TRUE(scene.dodge.has_value());
  EXPECT_TRUE(scene.dodge->lean);
  EXPECT_FALSE(scene.dodge->cover);
  EXPECT_EQ((*scene.floor)[3], 1.2);
}

struct Bad {
  std::string text, line, part;
};

class BadSceneFile : public testing::TestWithParam<Bad> {};

TEST_P(BadSceneFile, IsRefusedInOneLineWithThePlace) {
  try {
    Load(GetParam().text);
    FAIL() << GetParam().text;
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    EXPECT_NE(what.find("scene.toml: line " + GetParam().line + ": expected"), std::string::npos)
        << what;
    EXPECT_NE(what.find(GetParam().part), std::string::npos) << what;
  }
}

const std::string kBall = "[[object]]\nname = \"a\"\nshape = \"ball\"\nsize_m = 0.2\n";

INSTANTIATE_TEST_SUITE_P(
    EachFault, BadSceneFile,
    testing::Values(Bad{"[[object]]\nsize_m = [1, 1, 1]\n", "1", "name"},
                    Bad{"[[object]]\nname = \"a\"\n", "1", "size_m"},
                    Bad{"[[object]]\nname = \"a\"\nsize_m = [1, 2]\n", "3", "3 numbers"},
                    Bad{"[[object]]\nname = \"a\"\nsize_m = [1, 2, 0.001]\n", "3", "0.005"},
                    Bad{"[[object]]\nname = \"a\"\nshape = \"cone\"\n", "3", "box, ball, capsule"},
                    Bad{kBall + "mass_kg = -1\n", "5", "mass_kg"},
                    Bad{kBall + "mass_kg = nan\n", "5", "mass_kg"},
                    Bad{kBall + "colour = \"red\"\n", "5", "found 'colour'"},
                    Bad{kBall + "at_m = [0, 0, inf]\n", "5", "at_m"},
                    Bad{kBall + "person = 0.5\n", "5", "person"},
                    Bad{kBall + kBall, "5", "each name once"},
                    Bad{kBall + "[[grab]]\nobjects = [\"b\"]\n", "6", "found 'b'"},
                    Bad{kBall + "[[grab]]\njoints = [\"Thumb\"]\n", "6", "found 'Thumb'"},
                    Bad{kBall + "[[grab]]\nhands = 1.5\n", "6", "whole number"},
                    Bad{kBall + "[[release]]\naway_m = \"far\"\n", "6", "away_m as a number"},
                    Bad{kBall + "[dodge]\nlean = 1\n", "6", "true or false"},
                    Bad{"[object]\nname = \"a\"\n", "1", "[[object]]"},
                    Bad{"[[objekt]]\nname = \"a\"\n", "1", "found 'objekt'"},
                    Bad{"floor = [0, 2, 0, 1]\n", "1", "unit normal"},
                    Bad{"floor = [0, 1\n[[x]]", "2", "list"},
                    Bad{"name \"a\"\n", "1", "name = value"}, Bad{"[[object\n", "1", "[[name]]"},
                    Bad{"a = 1\na = 2\n", "2", "TOML"}));

TEST(SceneFile, MissingFileIsRefused) {
  EXPECT_THROW(LoadScene("/nowhere/scene.toml"), InputError);
  EXPECT_THROW(LoadScene("/dev/null"), InputError);
}

}  // namespace
}  // namespace ossa::tracker
