#include "recon/motion/bvh.h"

#include <gtest/gtest.h>

#include <numbers>

#include "depth/base/error.h"

namespace ossa::recon {
namespace {

const std::string kTwoJoints =
    "HIERARCHY\nROOT hips\n{\n  OFFSET 0 0 0\n  CHANNELS 6 Xposition Yposition Zposition Zrotation "
    "Xrotation Yrotation\n  JOINT knee {\n OFFSET 0 -2 0\n CHANNELS 3 Yrotation Zrotation "
    "Xrotation\n End Site { OFFSET 0 -3 0 } } }\nMOTION\nFrames: 1\nFrame Time: 0.05\n"
    "1 2 3 10 20 30 40 50 60\n";

Eigen::Quaterniond Turn(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kY = Eigen::Vector3d::UnitY(),
                      kZ = Eigen::Vector3d::UnitZ();

TEST(BvhReader, ComposesRotationsInTheOrderOfEachJointsChannels) {
  const BvhFile bvh = ParseBvh(kTwoJoints, "two.bvh");
  const BvhFramePose pose = ComputePose(bvh, 0);
  const Eigen::Quaterniond root = Turn(10, kZ) * Turn(20, kX) * Turn(30, kY);
  const Eigen::Quaterniond knee = root * Turn(40, kY) * Turn(50, kZ) * Turn(60, kX);
  // 1e-12: rounding of a handful of double products.
  EXPECT_LT(pose.rotation[0].angularDistance(root), 1e-12);
  EXPECT_LT(pose.rotation[1].angularDistance(knee), 1e-12);
  EXPECT_LT((pose.position[1] - (Eigen::Vector3d(1, 2, 3) + root * (-2 * kY))).norm(), 1e-12);
  EXPECT_EQ(bvh.joints[1].end_sites.size(), 1u);
  EXPECT_DOUBLE_EQ(bvh.frame_s, 0.05);
}

TEST(BvhReader, AcceptsWindowsLineEndsTabsCaseAndNamesWithBlanks) {
  std::string text =
      "\xEF\xBB\xBFhierarchy\nroot The Hips\n{\n\tOFFSET\t0 0 0\n\tChannels 1 "
      "zRotation\n}\nmotion\nframes: 2\nframe time: 0.1\n5\n\n6\n\n";
  std::string windows;
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const BvhFile bvh = ParseBvh(windows, "w.bvh");
  EXPECT_EQ(bvh.joints[0].name, "The Hips");
  EXPECT_EQ(bvh.FrameCount(), 2u);
}

TEST(BvhReader, PositionChannelsOfAnyJointReplaceItsOffset) {
  std::string text = kTwoJoints;
  text.replace(text.find("CHANNELS 3"), 10, "CHANNELS 6 Xposition Yposition Zposition");
  text.replace(text.find("40 50 60"), 8, "0 -5 0 40 50 60");
  const BvhFramePose pose = ComputePose(ParseBvh(text, "six.bvh"), 0);
  EXPECT_NEAR((pose.position[1] - pose.position[0]).norm(), 5.0, 1e-12);
}

struct BadText {
  const char* name;
  const char* cut;      // text replaced
  const char* instead;  // by this
  const char* message;  // what the refusal must say
};

class DamagedBvh : public testing::TestWithParam<BadText> {};

TEST_P(DamagedBvh, IsRefusedInOneLineWithTheLineNumber) {
  std::string text = kTwoJoints;
  const size_t at = text.find(GetParam().cut);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().cut).size(), GetParam().instead);
  try {
    ParseBvh(text, "bad.bvh");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("bad.bvh: line ")) << message;
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    OneDamageEach, DamagedBvh,
    testing::Values(
        BadText{"Header", "HIERARCHY", "HIERARCHIE", "line 1: expected 'HIERARCHY'"},
        BadText{"NoName", "ROOT hips", "ROOT", "line 2: expected a joint's name"},
        BadText{"Offset", "OFFSET 0 -2 0", "OFFSET 0 -2 zero", "OFFSET z (a number)"},
        BadText{"Infinite", "OFFSET 0 -2 0", "OFFSET 0 -2 1e300", "a number below 1e9"},
        BadText{"NotANumber", "OFFSET 0 -2 0", "OFFSET 0 nan 0", "OFFSET y"},
        BadText{"Count", "CHANNELS 3", "CHANNELS 7", "0 to 6 channels"},
        BadText{"Channel", "Yrotation\n  JOINT", "Wrotation\n  JOINT",
                "line 5: expected a channel"},
        BadText{"Twice", "Yrotation Zrotation", "Yrotation Yrotation", "each channel once"},
        BadText{"SameName", "JOINT knee", "JOINT hips", "every joint name once"},
        BadText{"Unclosed", "} } }", "} }", "'}' of joint hips, found 'MOTION'"},
        BadText{"TooManyClosed", "} } }", "} } } }", "expected 'MOTION', found '}'"},
        BadText{"Keyword", "OFFSET 0 -2 0", "OFSET 0 -2 0", "of joint knee"},
        BadText{"Frames", "Frames: 1", "Frames: -4", "at least 1"},
        BadText{"FrameTime", "Time: 0.05", "Time: 0", "a frame time between"},
        BadText{"Short", "40 50 60", "40 50", "9 numbers in a frame, found '8 numbers'"},
        BadText{"Long", "40 50 60", "40 50 60 70", "9 numbers in a frame, found '10 numbers'"},
        BadText{"Extra", "40 50 60\n", "40 50 60\n1\n", "9 numbers in a frame, found '1 numbers'"},
        BadText{"Value", "40 50 60", "40 5o 60", "line 13: expected a channel's value"},
        BadText{"Missing", "1 2 3 10 20 30 40 50 60\n", "", "frame 1 of 1"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(BvhReader, RefusesEveryTruncationWithoutCrashing) {
  for (size_t length = 0; length + 10 < kTwoJoints.size(); ++length) {
    EXPECT_THROW(ParseBvh(kTwoJoints.substr(0, length), "cut.bvh"), InputError) << length;
  }
}

TEST(BvhReader, RefusesAMillionNestedJointsWithoutStackOverflow) {
  std::string text = "HIERARCHY\nROOT r {\n";
  for (int i = 0; i < 1000000; ++i) text += "JOINT j" + std::to_string(i) + " {\n";
  EXPECT_THROW(ParseBvh(text, "deep.bvh"), InputError);
}

// Of a recording of hours every number that is kept twice is a gigabyte.
TEST(BvhReader, NeedsOnlyTheMemoryOfTheNumbers) {
  std::string text = kTwoJoints;
  text.replace(text.find("Frames: 1\n"), 10, "Frames: 1025\n");
  for (int frame = 1; frame < 1025; ++frame) text += "1 2 3 10 20 30 40 50 60\n";
  const BvhFile bvh = ParseBvh(text, "long.bvh");
  EXPECT_EQ(bvh.FrameCount(), 1025u);
  EXPECT_EQ(bvh.values.capacity(), bvh.values.size());
}

TEST(BvhReader, RefusesAMissingFile) { EXPECT_THROW(ReadBvh("/nonexistent/x.bvh"), InputError); }

}  // namespace
}  // namespace ossa::recon
