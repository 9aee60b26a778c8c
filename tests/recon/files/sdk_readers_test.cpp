// Skeletons recorded with other software: small texts made here, one reader at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <vector>

#include "depth/base/error.h"
#include "recon/orientation.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/recon/files/tar_bytes.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr double kExact = 1e-9;    // decimal text to double and a change of units
constexpr double kFloat_m = 1e-6;  // single precision at a few metres

SkeletonSequence Read(const std::string& text, const SkeletonReadOptions& options = {}) {
  std::istringstream stream(text);
  return ReadSkeletonStream(stream, "file", options);
}

void ExpectAt(const SkeletonSequence& sequence, size_t frame, Joint joint, double x, double y,
              double z, double tolerance = kExact) {
  EXPECT_LT((At(sequence, frame, joint) - Eigen::Vector3d(x, y, z)).norm(), tolerance)
      << NameOf(joint) << " is at " << At(sequence, frame, joint).transpose();
}

TEST(KinectGait, BeginsAFrameAtEachHead) {
  const auto read = Read(GaitText(3));
  ASSERT_EQ(read.frames.size(), 3u);
  EXPECT_EQ(read.sensor, "");  // a Kinect v1: no systematic errors are known of it
  ExpectAt(read, 2, Joint::kHead, 0.0, 0.2, 2);
  ExpectAt(read, 1, Joint::kHipCenter, 0.11, 0.1, 2);
  ExpectAt(read, 0, Joint::kFootLeft, 0.19, 0.0, 2);
  EXPECT_NEAR(read.frames[1].time_s, 1 / 30.0, kExact);
}

TEST(MsrAction3D, HasItsOwnOrderAndConfidences) {
  const auto read = Read(MsrText(2));
  ASSERT_EQ(read.frames.size(), 2u);
  ExpectAt(read, 1, Joint::kHead, 0.19, 0.1, 2);
  ExpectAt(read, 0, Joint::kHipCenter, 0.06, 0, 2);
  EXPECT_EQ(read.frames[0].bodies[0].joints[0]->confidence, 0.9);
}

TEST(UtKinect, TimesFollowFrameNumbersAndDuplicatesCountOnce) {
  const auto read = Read(UtText());
  ASSERT_EQ(read.frames.size(), 3u);
  EXPECT_NEAR(read.frames[2].time_s, 4 / 30.0, kExact);
  ExpectAt(read, 0, Joint::kFootRight, 0.19, 0.5, 2);
}

TEST(Msrc12, HasTicksAndFourNumbersAJoint) {
  const auto read = Read(Msrc12Text(3));
  ASSERT_EQ(read.frames.size(), 3u);
  EXPECT_NEAR(read.frames[2].time_s, 2 / 30.0, kExact);
  ExpectAt(read, 2, Joint::kHead, 0.03, 0.2, 2);
  ExpectAt(read, 0, Joint::kFootRight, 0.19, 0.0, 2);
}

TEST(MsrDailyActivity, HasPeopleByTheirRowsAndSkipsThoseInTheImage) {
  const auto read = Read(MsrDailyText(3));
  ASSERT_EQ(read.frames.size(), 3u);
  EXPECT_TRUE(read.frames[0].bodies.empty());
  ASSERT_EQ(read.frames[2].bodies.size(), 2u);
  EXPECT_EQ(read.frames[2].bodies[1].id, 2);
  ExpectAt(read, 1, Joint::kHandLeft, 0.07, 0.1, 2);
  EXPECT_NEAR(read.frames[1].time_s, 1 / 30.0, kExact);
  const auto more = Read("4" + MsrDailyText(3).substr(1));
  ASSERT_EQ(more.warnings.size(), read.warnings.size() + 1);
  EXPECT_NE(more.warnings[0].find("counts 4 frames, the file has 3"), std::string::npos);
}

TEST(PkuMmd, HasTwoPeopleWhoAreZerosWhereNobodyWasSeen) {
  const auto read = Read(PkuMmdText(2));
  ASSERT_EQ(read.frames.size(), 2u);
  EXPECT_EQ(read.sensor, kKinectV2);
  ASSERT_EQ(read.frames[1].bodies.size(), 1u);
  ExpectAt(read, 1, Joint::kShoulderCenter, 0.20, 0.1, 2);  // SpineShoulder, index 20
  ExpectAt(read, 1, Joint::kHead, 0.03, 0.1, 2);
}

TEST(Labanotation, ReadsTwentyOfTwentyFiveJointsWithTicksAndStates) {
  const auto read = Read(LabanText(2));
  ASSERT_EQ(read.frames.size(), 2u);
  EXPECT_EQ(read.sensor, kKinectV2);
  EXPECT_NEAR(read.frames[1].time_s, 0.033, 1e-7);
  ExpectAt(read, 1, Joint::kShoulderCenter, 0.20, 0.1, 2);  // SpineShoulder, index 20
  ExpectAt(read, 1, Joint::kHead, 0.03, 0.1, 2);
  const auto& joints = read.frames[0].bodies[0].joints;
  EXPECT_EQ(joints[0]->state, TrackingState::kNotTracked);
  EXPECT_EQ(joints[1]->state, TrackingState::kInferred);
  EXPECT_EQ(joints[2]->state, TrackingState::kTracked);  // 20 % 3
}

TEST(Keraal, ReadsPositionsAndQuaternions) {
  const auto read = Read(KeraalText(175));
  ExpectAt(read, 0, Joint::kHandLeft, 0.07, 0.1, 2);
  const auto& q = read.frames[0].bodies[0].joints[0]->orientation;
  ASSERT_TRUE(q.has_value());
  EXPECT_NEAR(q->w(), 0.8, kExact);
  EXPECT_NEAR(q->z(), 0.6, kExact);
}

TEST(Keraal, ViconTargetsAreMillimetresWithZUp) {
  const auto read = Read(KeraalText(119));
  // Target 14, the head, is at (0.14, 0.1, 2) mm with z up: y = 2 mm, z = -0.1 mm.
  ExpectAt(read, 0, Joint::kHead, 0.14e-3, 2e-3, -0.1e-3);
}

TEST(Ntu, ReadsBodiesAndLeavesEmptyFramesEmpty) {
  const auto read = Read(NtuText());
  ASSERT_EQ(read.frames.size(), 2u);
  EXPECT_TRUE(read.frames[0].bodies.empty());
  EXPECT_EQ(read.frames[1].bodies[0].id, 1);
  ExpectAt(read, 1, Joint::kAnkleRight, 0.18, 0.3, 2);
}

TEST(Ntu, OrientationsFollowTheConventionOfSdk1) {
  const auto read = Read(ReplacedAll(NtuText(), "0.2 0.1 0.3 nan", "0.5 0.5 0.5 0.5"));
  const Eigen::Quaterniond sdk2(0.5, 0.5, 0.5, 0.5);
  const auto& joints = read.frames[1].bodies[0].joints;
  for (const Joint joint : {Joint::kHipCenter, Joint::kElbowLeft, Joint::kKneeRight}) {
    ASSERT_TRUE(joints[joint]->orientation.has_value());
    EXPECT_TRUE(joints[joint]->orientation->isApprox(OrientationFromSdk2(joint, sdk2), kExact));
  }
  EXPECT_TRUE(joints[Joint::kHipCenter]->orientation->isApprox(sdk2, kExact));
  // A quarter turn about the upper arm: the SDK 2's x axis is our z axis.
  EXPECT_NEAR((*joints[Joint::kElbowLeft]->orientation * Eigen::Vector3d::UnitZ() -
               sdk2 * Eigen::Vector3d::UnitX())
                  .norm(),
              0.0, 1e-9);
}

TEST(Ntu, WithoutOrientationsKeepsThePositions) {
  for (const char* none : {"0 0 0 0", "nan nan nan nan", "? ? ? ?"}) {
    const auto read = Read(ReplacedAll(NtuText(), "0.2 0.1 0.3 nan", none));
    ExpectAt(read, 1, Joint::kAnkleRight, 0.18, 0.3, 2);
    EXPECT_FALSE(read.frames[1].bodies[0].joints[Joint::kAnkleRight]->orientation.has_value());
  }
}

TEST(UiPrmdTable, ContainsTwoSkeletonsToChooseFrom) {
  const std::string text =
      "t_s,K_Waist_SpineBase_x,K_Waist_SpineBase_y,K_Waist_SpineBase_z,K_Neck2_Neck_x,"
      "K_Neck2_Neck_y,K_Neck2_Neck_z,K_LHand_LWrist_x,K_LHand_LWrist_y,K_LHand_LWrist_z,"
      "G_head_x,G_head_y,G_head_z,G_Lwri_x,G_Lwri_y,G_Lwri_z\n"
      "0.5,-16,80,-246,1,1,1,10,20,-30,1,150,-240,,,\n";
  SkeletonReadOptions options;
  options.columns = "kinect";
  const auto kinect = Read(text, options);
  EXPECT_EQ(kinect.frames[0].time_s, 0.5);
  // The subject's left is x in the file and faces the sensor: negative x in camera space.
  ExpectAt(kinect, 0, Joint::kHipCenter, 0.16, 0.80, 2.46);
  ExpectAt(kinect, 0, Joint::kWristLeft, -0.10, 0.20, 0.30);
  EXPECT_FALSE(kinect.frames[0].bodies[0].joints[2].has_value()) << "the SDK 2 neck is not ours";
  options.columns = "truth";
  const auto vicon = Read(text, options);
  ExpectAt(vicon, 0, Joint::kHead, -0.01, 1.50, 2.40);
  EXPECT_FALSE(vicon.frames[0].bodies[0].joints[6].has_value()) << "empty: no Vicon";
  EXPECT_NE(ComplaintAbout(text).find("file#truth or file#observed"), std::string::npos);
}

TEST(Itop, NegatesTheXAxis) {
  const std::string text =
      "frame,G_RHand_x,G_RHand_y,G_RHand_z,P_RHand_x,P_RHand_y,P_RHand_z\n"
      "3,-0.4,0.1,2.5,-0.5,0.2,2.6\n"
      "4,-0.4,0.1,2.5,-0.5,0.2,2.6\n";
  SkeletonReadOptions options;
  options.columns = "truth";
  // The right hand of a person who faces the camera is at its left: positive x in camera space.
  ExpectAt(Read(text, options), 0, Joint::kHandRight, 0.4, 0.1, 2.5);
  options.columns = "estimate";
  const SkeletonSequence estimate = Read(text, options);
  ExpectAt(estimate, 0, Joint::kHandRight, 0.5, 0.2, 2.6);
  EXPECT_NEAR(estimate.frames[1].time_s - estimate.frames[0].time_s, 0.1, kExact);  // 10 Hz
}

// A chain bent at the spine: 90 degrees about z turns what follows from up to the left.
TEST(UiPrmdOriginal, ComposesOffsetsAndAngles) {
  const test::TemporaryFolder folder;
  std::vector<double> offsets(66, 0.0);
  std::vector<double> angles(66, 0.0);
  offsets[0] = 10;
  offsets[1] = 90;
  offsets[2] = -240;    // waist
  offsets[3 + 1] = 25;  // spine above it
  angles[3 + 2] = 90;   // turned about z
  offsets[6 + 1] = 20;  // chest "above" the spine: now towards -x of the file
  const auto write = [&](const std::string& name, const std::vector<double>& values) {
    std::ofstream file(folder / name);
    for (size_t i = 0; i < values.size(); ++i) file << (i > 0 ? "," : "") << values[i];
    file << "\n";
  };
  write("m01_positions.txt", offsets);
  EXPECT_THROW(ReadSkeletons(folder / "m01_positions.txt"), InputError) << "no angles beside it";
  write("m01_angles.txt", angles);
  const auto read = ReadSkeletons(folder / "m01_positions.txt");
  ExpectAt(read, 0, Joint::kHipCenter, -0.10, 0.90, 2.40);
  ExpectAt(read, 0, Joint::kSpine, -0.10, 1.15, 2.40);
  ExpectAt(read, 0, Joint::kShoulderCenter, 0.10, 1.15, 2.40);
}

TEST(UiPrmdOriginal, GivesJointCentresFromMarkers) {
  // Head markers around (0, 100, 1700) mm, wrist markers 60 mm apart; others missing.
  std::string text;
  for (int m = 0; m < 39; ++m) {
    std::string place = "0,0,0";
    if (m == 0) place = "70,170,1700";
    if (m == 1) place = "-70,170,1700";
    if (m == 2) place = "70,30,1700";
    if (m == 3) place = "-70,30,1700";
    if (m == 13) place = "300,0,1000";
    if (m == 14) place = "300,60,1000";
    text += (m > 0 ? "," : "") + place;
  }
  const auto read = Read(text + "\n");
  ExpectAt(read, 0, Joint::kHead, 0, 1.7, -0.1);
  ExpectAt(read, 0, Joint::kWristLeft, 0.3, 1.0, -0.03);
  EXPECT_FALSE(read.frames[0].bodies[0].joints[13].has_value());
}

// They have as many numbers as Vicon's markers or Kinect's joints: degrees must not be read as
// lengths.
TEST(UiPrmdOriginal, AnglesFilesAreRefused) {
  const test::TemporaryFolder folder;
  for (const int columns : {117, 66}) {
    std::ofstream file(folder / "m01_s01_e01_angles.txt");
    for (int i = 0; i < columns; ++i) file << (i > 0 ? "," : "") << i;
    file << "\n";
    file.close();
    test::ExpectRefused([&] { ReadSkeletons(folder / "m01_s01_e01_angles.txt"); },
                        "m01_s01_e01_angles.txt: expected places, as in a ..._positions.txt, found "
                        "the joint angles");
  }
}

TEST(AzureKinect, ConvertsAxesAndMillimetres) {
  const auto read = Read(AzureText());
  ASSERT_EQ(read.frames.size(), 2u);
  EXPECT_EQ(read.frames[0].bodies[0].id, 4);
  ExpectAt(read, 0, Joint::kHipCenter, 0.1, -0.2, 2.5);
  ExpectAt(read, 0, Joint::kHead, -0.01, 0.6, 2.4);
  EXPECT_NEAR(read.frames[1].time_s, 0.033333, kExact);
}

TEST(AzureKinect, WarnsThatOrientationsAreNotRead) {
  EXPECT_TRUE(Read(AzureText()).warnings.empty());
  const auto read =
      Read(ReplacedAll(AzureText(), "_orientations\":[]", "_orientations\":[[1,0,0,0]]"));
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("joint_orientations are not read"), std::string::npos)
      << read.warnings[0];
}

TEST(KinectStreamSaver, ReadsOnlyTrackedSkeletons) {
  const auto read = Read(SaverBytes(3));
  ASSERT_EQ(read.frames.size(), 3u);
  ASSERT_EQ(read.frames[1].bodies.size(), 1u);
  EXPECT_EQ(read.frames[1].bodies[0].id, 3);
  ExpectAt(read, 2, Joint::kFootRight, 0.19, 0.2, 2, kFloat_m);
}

// Two frames, 40 ms apart.
std::string SaverTimesBytes() {
  std::string bytes(2 * 5 * sizeof(int64_t), '\0');
  Put<int64_t>(bytes, 4 * sizeof(int64_t), 5000);
  Put<int64_t>(bytes, 9 * sizeof(int64_t), 5040);
  return bytes;
}

TEST(KinectStreamSaver, ReadsTimesFromTheFileBesideIt) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "Joint_Position.binary", std::ios::binary) << SaverBytes(2);
  std::ofstream(folder / "liTimeStamp.binary", std::ios::binary) << SaverTimesBytes();
  EXPECT_NEAR(ReadSkeletons(folder / "Joint_Position.binary").frames[1].time_s, 0.040, kExact);
}

void ExpectOwnTimes(const SkeletonSequence& read, double second_s) {
  EXPECT_NEAR(read.frames[1].time_s, second_s, kExact);
  ASSERT_FALSE(read.warnings.empty());
  EXPECT_NE(read.warnings.back().find("times of its own"), std::string::npos);
}

TEST(FrameRate, AppliesToFilesWithoutTimes) {
  SkeletonReadOptions slower;
  slower.frame_s = 0.125;
  const test::TemporaryFolder folder;
  std::ofstream(folder / "Joint_Position.binary", std::ios::binary) << SaverBytes(2);
  EXPECT_NEAR(ReadSkeletons(folder / "Joint_Position.binary", slower).frames[1].time_s, 0.125,
              kExact);
  std::ofstream(folder / "liTimeStamp.binary", std::ios::binary) << SaverTimesBytes();
  ExpectOwnTimes(ReadSkeletons(folder / "Joint_Position.binary", slower), 0.040);
  std::ofstream(folder / "x.c3d", std::ios::binary) << C3dBytes();
  ExpectOwnTimes(ReadSkeletons(folder / "x.c3d", slower), 0.02);
}

// The file of times is not a recording of its own.
TEST(KinectStreamSaver, IsReadFromFoldersAndArchives) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "walk");
  std::ofstream(folder / "walk/Joint_Position.binary", std::ios::binary) << SaverBytes(2);
  std::ofstream(folder / "walk/liTimeStamp.binary", std::ios::binary) << SaverTimesBytes();
  EXPECT_NEAR(ReadSkeletons(folder / "walk").frames[1].time_s, 0.040, kExact);
  WriteTar(folder / "walk.tar", {{"walk/Joint_Position.binary", SaverBytes(2)},
                                 {"walk/liTimeStamp.binary", SaverTimesBytes()}});
  EXPECT_NEAR(ReadSkeletons(folder / "walk.tar").frames[1].time_s, 0.040, kExact);
}

TEST(C3d, ReadsLabelledPointsWithZUp) {
  const auto read = Read(C3dBytes());
  ASSERT_EQ(read.frames.size(), 3u);
  EXPECT_NEAR(read.frames[1].time_s, 0.02, kExact);
  ExpectAt(read, 1, Joint::kHead, 0.1, 1.0, 0.01, kFloat_m);
  EXPECT_FALSE(read.frames[2].bodies[0].joints[3].has_value()) << "a negative residual: not seen";
}

struct Wrong {
  const char* name;
  std::string text;
  std::string named;
};

void PrintTo(const Wrong& value, std::ostream* out) { *out << value.name; }

std::string NameOfCase(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

class WrongSdkFile : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSdkFile, IsRefusedInOneLineWithPlaceAndExpectation) {
  const std::string complaint = ComplaintAbout(GetParam().text);
  EXPECT_TRUE(complaint.starts_with("file")) << complaint;
  EXPECT_NE(complaint.find("expected"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find(GetParam().named), std::string::npos) << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
  EXPECT_LT(complaint.size(), 300u);
}

std::string Cut(const std::string& text, size_t from_end) {
  return text.substr(0, text.size() - from_end);
}

std::string With(std::string text, const std::string& old, const std::string& fresh,
                 size_t from = 0) {
  const size_t place = text.find(old, from);
  if (place == std::string::npos) throw std::logic_error("nothing to replace: " + old);
  return text.replace(place, old.size(), fresh);
}

INSTANTIATE_TEST_SUITE_P(
    Truncated, WrongSdkFile,
    testing::Values(Wrong{"KinectGait", Cut(GaitText(2), 40), "line 39: expected Name;x;y;z"},
                    Wrong{"KinectGaitLine", With(GaitText(2), "Foot-Left;0.19;0.1;2\r\n", ""),
                          "FootLeft before the next frame"},
                    Wrong{"MsrAction3dLine", With(MsrText(2), "0.19 0.1 2 0.9\n", ""),
                          "line 20 of the frame's 20"},
                    Wrong{"MsrAction3d", Cut(MsrText(2), 20), "line 39: expected 4 numbers"},
                    Wrong{"Labanotation", Cut(LabanText(2), 60), "line 2: expected 101 numbers"},
                    Wrong{"Ntu", Cut(NtuText(), 60), "line 29"},
                    Wrong{"Azure", Cut(AzureText(), 30), "JSON"},
                    Wrong{"StreamSaver", Cut(SaverBytes(2), 7), "whole frames"},
                    Wrong{"C3d", Cut(C3dBytes(), 500), "all frames up to byte"}),
    NameOfCase);

INSTANTIATE_TEST_SUITE_P(
    WrongColumns, WrongSdkFile,
    testing::Values(Wrong{"Labanotation", LabanText(1) + "1,2,3\n", "line 2: expected 101 numbers"},
                    Wrong{"Keraal", KeraalText(175) + KeraalText(119),
                          "line 2: expected 175 numbers"},
                    Wrong{"UtKinect", UtText() + "7 1 2 3\n", "line 5: expected 61 numbers"},
                    Wrong{"Msrc12", Msrc12Text(2) + "7 1 2 3\n", "line 3: expected 81 numbers"},
                    Wrong{"PkuMmd", PkuMmdText(1) + "1 2\n", "line 2: expected 150 numbers"},
                    Wrong{"MsrDailyRows", MsrDailyText(3) + "41\n", "a count of rows, 40 a person"},
                    Wrong{"MsrDailyEnd", MsrDailyText(3) + "40\n1 2 3 1\n", "row 2 of a person's"},
                    Wrong{"MsrAction3d", MsrText(1) + "1 2 3\n", "line 21: expected 4 numbers"},
                    Wrong{"KinectGait", GaitText(1) + "Head;1;2\n", "line 21: expected Name;x;y;z"},
                    Wrong{"Ntu", With(NtuText(), "25\n", "20\n"), "count of joints"}),
    NameOfCase);

INSTANTIATE_TEST_SUITE_P(
    MixedJointSets, WrongSdkFile,
    testing::Values(
        Wrong{"UnknownJoint", With(GaitText(2), "Foot-Left", "HandTip-Left", 600), "20 SDK joints"},
        Wrong{"JointTwice", With(GaitText(2), "Foot-Left", "Foot-Right"), "each joint once"},
        Wrong{"Azure", With(AzureText(), ",[10,-600,2400]", ""), "3 joint_positions"}),
    NameOfCase);

INSTANTIATE_TEST_SUITE_P(
    NotNumbers, WrongSdkFile,
    testing::Values(
        Wrong{"KinectGait", With(GaitText(2), ";0.1;2", ";nan;2"), "finite number for y"},
        Wrong{"Labanotation", With(LabanText(2), "0.24", "inf", 400), "line 2"},
        Wrong{"LabanotationState", With(LabanText(2), ",2,2,", ",2,7,"), "state 0, 1 or 2"},
        Wrong{"Keraal", With(KeraalText(175) + KeraalText(175), "0.8", "x", 700), "line 2"},
        Wrong{"Ntu", With(NtuText(), "0.3 2 277", "inf 2 277"), "finite number"},
        Wrong{"Azure", With(AzureText(), "-600", "\"-600\""), "three finite numbers"},
        Wrong{"MsrConfidence", With(MsrText(1), "0.9", "9"), "confidence"}),
    NameOfCase);

INSTANTIATE_TEST_SUITE_P(
    HugeLine, WrongSdkFile,
    testing::Values(Wrong{"KinectGait", GaitText(1) + std::string(2 << 20, '1'), "1 MiB"},
                    Wrong{"Labanotation", LabanText(1) + std::string(2 << 20, '1'), "1 MiB"},
                    Wrong{"Ntu", NtuText() + std::string(2 << 20, '1'), "1 MiB"}),
    NameOfCase);

TEST(C3d, FileWithoutVisiblePointsHasNoBody) {
  std::string unseen = C3dBytes();
  for (size_t point = 0; point < 6; ++point) Put<float>(unseen, 1024 + 16 * point + 12, -1.0f);
  const auto read = Read(unseen);
  ASSERT_EQ(read.frames.size(), 3u);
  for (const SkeletonFrame& frame : read.frames) EXPECT_TRUE(frame.bodies.empty());
}

TEST(C3d, UnknownProcessorIsRefusedByName) {
  std::string bytes = C3dBytes();
  bytes[512 + 3] = 99;
  EXPECT_NE(ComplaintAbout(bytes).find("processor type"), std::string::npos);
}

// Each byte of the parameter section inverted, one at a time: the file is read or refused, without
// a crash.
TEST(C3d, SurvivesDamageAnywhere) {
  const std::string good = C3dBytes();
  for (size_t byte = 0; byte < 620; ++byte) {
    std::string bad = good;
    bad[byte] = static_cast<char>(bad[byte] ^ 0x5A);
    EXPECT_EQ(ComplaintAbout(bad).find('\n'), std::string::npos);
  }
}

struct RealFile {
  const char* name;
  const char* path;
  size_t frames;
};

void PrintTo(const RealFile& value, std::ostream* out) { *out << value.name; }

class RealSamples : public testing::TestWithParam<RealFile> {};

// Bones of all real files have human lengths if units and joint maps are right.
TEST_P(RealSamples, HaveHumanSize) {
  const std::string path = (test::SharedFolder() / "real" / GetParam().path).string();
  if (!std::filesystem::exists(path.substr(0, path.find('#')))) {
    GTEST_SKIP() << path << " is not here";
  }
  const auto sequence = ReadSkeletons(path);
  EXPECT_GE(sequence.frames.size(), GetParam().frames);
  const size_t middle = sequence.frames.size() / 2;
  // ITOP has feet and no ankles.
  const bool ankles = sequence.frames[middle].bodies.at(0).joints[14].has_value();
  const Joint end = ankles ? Joint::kAnkleLeft : Joint::kFootLeft;
  const double shin_m = (At(sequence, middle, Joint::kKneeLeft) - At(sequence, middle, end)).norm();
  EXPECT_GT(shin_m, 0.2);
  EXPECT_LT(shin_m, 0.6);
  EXPECT_GT(At(sequence, middle, Joint::kHead).y(), At(sequence, middle, Joint::kKneeLeft).y());
}

/// Compares the SDK's orientations of a bone with those of ComputeOrientations over a Kinect SDK 2
/// recording: the angle between the bones' axes, and the axial difference.
struct AgainstSdk2 {
  double apart_rad = 0.0, about_rad = 0.0;
};

AgainstSdk2 MedianAgainstSdk2(const SkeletonSequence& sequence, Joint joint) {
  std::vector<double> apart, about;
  for (const SkeletonFrame& frame : sequence.frames) {
    const auto& sdk = frame.bodies.at(0).joints[joint]->orientation;
    if (!sdk) continue;
    const TrackedPosture seen = ToTrackedPosture(frame.bodies[0]);
    const Eigen::Quaterniond ours = ComputeOrientations(seen.posture)[Index(joint)];
    const Eigen::Matrix3d turn = (ours.conjugate() * *sdk).toRotationMatrix();
    apart.push_back(std::acos(std::clamp(turn(1, 1), -1.0, 1.0)));
    about.push_back(std::atan2(-turn(2, 0), turn(0, 0)));
  }
  const auto median = [](std::vector<double> values) {
    std::nth_element(values.begin(),
                     values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  return {median(apart), median(about)};
}

// docs/kinect_sdk.md: the SDK 2's orientations, as they are read. Those of wrists and hands turn
// with thumb and fingers, which the joints do not determine.
TEST(RealKinectV2, OrientationsMatchOurs) {
  const std::string path =
      test::SharedFolder() / "real/keraal_kinect_vicon/pairs/G3-Kinect-CTK-P1T1-Unknown-C-0.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const SkeletonSequence sequence = ReadSkeletons(path);
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const Joint joint :
       {Joint::kHipCenter, Joint::kSpine, Joint::kShoulderCenter, Joint::kShoulderLeft,
        Joint::kShoulderRight, Joint::kHipLeft, Joint::kHipRight, Joint::kElbowLeft,
        Joint::kElbowRight, Joint::kKneeLeft, Joint::kKneeRight, Joint::kAnkleLeft,
        Joint::kAnkleRight}) {
    const AgainstSdk2 median = MedianAgainstSdk2(sequence, joint);
    EXPECT_LT(median.apart_rad, 2.0 * kDegree) << kJointNames[Index(joint)];
    // The SDK derives a shin's axial rotation also from the foot: some ten degrees apart.
    EXPECT_NEAR(median.about_rad, 0.0, 12.0 * kDegree) << kJointNames[Index(joint)];
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, RealSamples,
    testing::Values(
        RealFile{"KinectGait", "sdk_skeletons/kinectgait_v1_txt/Person001/1.txt", 100},
        RealFile{"Labanotation", "sdk_skeletons/labanotation_v2_csv/Ges01_wavehand.csv", 100},
        RealFile{"KeraalKinect", "keraal_kinect_vicon/pairs/G3-Kinect-CTK-P1T1-Unknown-C-0.txt",
                 100},
        RealFile{"KeraalVicon", "keraal_kinect_vicon/pairs/G3-Vicon-CTK-P1T1-Unknown-C-0.txt", 100},
        RealFile{"KeraalSeated",
                 "keraal_kinect_vicon/kinect_only/Assis1Maxime/SkeletonSequence1.txt", 50},
        RealFile{"Itop", "itop_a2j/itop_side_truth_and_a2j.csv.gz#truth", 2431},
        RealFile{"UiPrmdKinect", "uiprmd_kinect_vicon/raw_e05.tar.gz#Kinect_Positions/m01_s10_e05",
                 40},
        RealFile{"UiPrmdVicon", "uiprmd_kinect_vicon/raw_e05.tar.gz#Vicon_Positions/m01_s10_e05",
                 100}),
    [](const testing::TestParamInfo<RealFile>& info) { return info.param.name; });

}  // namespace
}  // namespace ossa::recon
