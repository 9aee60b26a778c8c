// Tables of named joints: one joint per line, or one frame per row.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// A leg of 0.4 m bones that moves by a millimetre, in metres.
const std::string kJointLines =
    "0 SpineBase 0.1 0.2 2 0.9\n"
    "0 HIPLEFT 0.1 0.1 2 0.8\n"
    "0 knee_left 0.1 -0.3 2 0.7\n"
    "0 Head 0.1 0.8 2 0.6\n"
    "1 SpineBase 0.101 0.2 2 0.9\n"
    "1 HIPLEFT 0.1 0.1 2 0.8\n"
    "1 knee_left 0.1 -0.3 2 0.7\n"
    "1 Head 0.1 0.8 2 0.6\n";

const std::string kJointColumns =
    "time,SpineBase_x,SpineBase_y,SpineBase_z,HipLeft.X,HipLeft.Y,HipLeft.Z,KneeLeft (x),"
    "KneeLeft (y),KneeLeft (z),Head_Position_x,Head_Position_y,Head_Position_z,Hand "
    "state,HandLeft__\n"
    "5.00,0.1,0.2,2,0.1,0.1,2,0.1,-0.3,2,0.1,0.8,2,open,\n"
    "5.04,0.101,0.2,2,0.1,0.1,2,0.1,-0.3,2,0.1,0.8,2,open,\n";

void ExpectLeg(const SkeletonSequence& read) {
  ASSERT_EQ(read.frames.size(), 2u);
  const auto expect = [&](size_t frame, Joint joint, const Eigen::Vector3d& place_m) {
    EXPECT_LT((At(read, frame, joint) - place_m).norm(), 1e-12) << kJointNames[Index(joint)];
  };
  expect(0, Joint::kHipCenter, {0.1, 0.2, 2});
  expect(1, Joint::kHipCenter, {0.101, 0.2, 2});
  expect(0, Joint::kHipLeft, {0.1, 0.1, 2});
  expect(1, Joint::kKneeLeft, {0.1, -0.3, 2});
  expect(1, Joint::kHead, {0.1, 0.8, 2});
}

bool Tells(const SkeletonSequence& read, const std::string& what) {
  return std::any_of(read.warnings.begin(), read.warnings.end(), [&](const std::string& warning) {
    return warning.find(what) != std::string::npos;
  });
}

TEST(JointLines, AreFramesOfNamedJointsWithTheirConfidence) {
  const auto read = ReadText(kJointLines);
  ExpectLeg(read);
  EXPECT_NEAR(read.frames[1].time_s, 1.0 / 30.0, 1e-12);
  EXPECT_EQ(read.frames[1].bodies[0].joints[Index(Joint::kKneeLeft)]->confidence, 0.7);
  SkeletonReadOptions slower;
  slower.frame_s = 0.1;
  EXPECT_NEAR(ReadText(kJointLines, slower).frames[1].time_s, 0.1, 1e-12);
}

TEST(JointLines, MayHaveOtherSeparatorsAndAHeader) {
  for (const char* separator : {",", "\t", ";", " , "})
    ExpectLeg(ReadText(ReplacedAll(kJointLines, " ", separator)));
  ExpectLeg(ReadText(ReplacedAll(ReplacedAll(kJointLines, " ", ";"), ".", ",")));
  ExpectLeg(ReadText("frame joint x y z confidence\n" + kJointLines));
  const auto other = ReadText("z,y,x,name,time_ms\n2,0.1,0.1,HipLeft,40\n2,-0.3,0.1,KneeLeft,40\n");
  EXPECT_NEAR(other.frames.at(0).time_s, 0.04, 1e-12);
  EXPECT_LT((At(other, 0, Joint::kKneeLeft) - Eigen::Vector3d(0.1, -0.3, 2)).norm(), 1e-12);
}

TEST(JointLines, BeginWithAFrameOrATime) {
  const auto second = [](const std::string& first, const std::string& next) {
    std::string text = ReplacedAll(kJointLines, "\n1 ", "\n" + next + " ");
    text = ReplacedAll("\n" + text, "\n0 ", "\n" + first + " ").substr(1);
    const auto read = ReadText(text);
    return std::pair{read.frames.at(1).time_s - read.frames.at(0).time_s, read.warnings.size()};
  };
  EXPECT_NEAR(second("100", "102").first, 2.0 / 30.0, 1e-9);
  EXPECT_NEAR(second("100.25", "100.29").first, 0.04, 1e-9);
  EXPECT_EQ(second("100.25", "100.29").second, 0U);
  EXPECT_NEAR(second("1605531234567", "1605531234600").first, 0.033, 1e-6);
  EXPECT_EQ(second("1605531234567", "1605531234600").second, 1U);
  const std::string ticks = "\n" + ReplacedAll(kJointLines, "\n1 ", "\n333333 ");
  EXPECT_NE(ComplaintAbout(ticks).find("a header says other units"), std::string::npos);
}

TEST(JointColumns, AreFramesUnderAHeaderOfNamesAndAxes) {
  const auto read = ReadText(kJointColumns);
  ExpectLeg(read);
  EXPECT_NEAR(read.frames[1].time_s, 5.04, 1e-12);
  EXPECT_TRUE(read.frames[0].bodies.size() == 1);
  ExpectLeg(ReadText(ReplacedAll(kJointColumns, ",", ";")));
  const auto frames =
      ReadText(ReplacedAll(ReplacedAll(kJointColumns, "time,", "Frame,"), "5.0", ""));
  EXPECT_NEAR(frames.frames[1].time_s, 4.0 / 30.0, 1e-12);
}

TEST(JointLines, BlankNanAndOriginAreMissingJoints) {
  for (const char* gap : {",,", "nan,nan,nan", "0,0,0"}) {
    const std::string text = ReplacedAll(ReplacedAll(kJointLines, " ", ","), "0.101,0.2,2", gap);
    const auto read = ReadText(ReplacedAll(text, ",0.9", ""));
    EXPECT_FALSE(read.frames.at(1).bodies.at(0).joints[Index(Joint::kHipCenter)]) << gap;
    EXPECT_TRUE(read.frames.at(0).bodies.at(0).joints[Index(Joint::kHipCenter)]) << gap;
  }
}

TEST(JointColumns, BlankNanAndOriginAreMissingJoints) {
  for (const char* gap : {",,", "nan,nan,nan", "0,0,0"}) {
    const auto read = ReadText(ReplacedAll(kJointColumns, "0.101,0.2,2", gap));
    EXPECT_FALSE(read.frames.at(1).bodies.at(0).joints[Index(Joint::kHipCenter)]) << gap;
    EXPECT_TRUE(read.frames.at(0).bodies.at(0).joints[Index(Joint::kHipCenter)]) << gap;
  }
}

TEST(JointTables, KeepTheJointToWhichAllOthersAreRelative) {
  const std::string relative =
      "0 SpineBase 0 0 0\n0 HipLeft 100 -50 0\n0 KneeLeft 100 -450 0\n0 HandLeft 0 0 0\n"
      "1 SpineBase 0 0 0\n1 HipLeft 100 -50 0\n1 KneeLeft 100 -450 0\n1 HandLeft 300 0 0\n";
  const auto read = ReadText(relative);
  EXPECT_EQ(At(read, 1, Joint::kHipCenter), Eigen::Vector3d(0, 0, 0));
  EXPECT_NEAR(At(read, 1, Joint::kKneeLeft).y(), -0.45, 1e-12);
  EXPECT_FALSE(read.frames[0].bodies[0].joints[Index(Joint::kHandLeft)]) << "not in all rows";
  const auto near = ReadText("0 FootLeft 0 0 0\n0 HipLeft 0 0 1\n0 KneeLeft 0 -0.4 1\n");
  EXPECT_FALSE(near.frames[0].bodies[0].joints[Index(Joint::kFootLeft)]) << "before a camera";
}

TEST(JointTables, MillimetresAndCentimetresAreRecognisedByTheLimbsWithANote) {
  const auto thousandfold = [](double units) {
    std::ostringstream text;
    text << "frame,HipLeft_x,HipLeft_y,HipLeft_z,KneeLeft_x,KneeLeft_y,KneeLeft_z,Head_x,Head_y,"
            "Head_z\n1,"
         << 0.1 * units << ',' << 0.1 * units << ',' << 2 * units << ',' << 0.1 * units << ','
         << -0.3 * units << ',' << 2 * units << ",,,\n";
    return ReadText(text.str());
  };
  for (const auto& [units, told] :
       {std::pair{1.0, ""}, {100.0, "taken as centimetres"}, {1000.0, "taken as millimetres"}}) {
    const auto read = thousandfold(units);
    EXPECT_NEAR((At(read, 0, Joint::kHipLeft) - At(read, 0, Joint::kKneeLeft)).norm(), 0.4, 1e-9);
    EXPECT_NEAR(At(read, 0, Joint::kKneeLeft).z(), 2.0, 1e-9);
    EXPECT_EQ(Tells(read, "taken as"), *told != '\0') << units;
    EXPECT_TRUE(Tells(read, told) || *told == '\0') << units;
  }
  EXPECT_TRUE(
      Tells(ReadText(ReplacedAll(kJointColumns, "KneeLeft", "FootLeft")), "taken as metres"));
}

TEST(JointTables, CountedFromOneBeginAtTimeZero) {
  const auto read = ReadText(ReplacedAll(ReplacedAll(kJointLines, "\n1 ", "\n2 "), "0 ", "1 "));
  EXPECT_EQ(read.frames.at(0).time_s, 0.0);
  EXPECT_NEAR(read.frames.at(1).time_s, 1.0 / 30.0, 1e-12);
  EXPECT_TRUE(Tells(read, "its first frame is number 1"));
}

/// kJointColumns' people under other names, turned by half a turn about z.
TEST(JointTables, OfAzureKinectAreTurnedFromTheImagesAxes) {
  std::string text = "time_ms";
  for (const char* joint : {"PELVIS", "SPINE_NAVEL", "HEAD", "NOSE", "HIP_LEFT", "KNEE_LEFT"}) {
    for (const char* axis : {"_x", "_y", "_z"}) text += std::string(",K4ABT_JOINT_") + joint + axis;
  }
  text += "\n40,-100,-200,2000,-100,-400,2000,-100,-800,2000,0,0,0,-100,-100,2000,-100,300,2000\n";
  const auto read = ReadText(text);
  EXPECT_LT((At(read, 0, Joint::kHead) - Eigen::Vector3d(0.1, 0.8, 2)).norm(), 1e-12);
  EXPECT_LT((At(read, 0, Joint::kKneeLeft) - Eigen::Vector3d(0.1, -0.3, 2)).norm(), 1e-12);
  EXPECT_TRUE(Tells(read, "the axes are taken as an image's"));
}

TEST(JointTables, HaveNamesWithACommonBeginning) {
  std::string text = kJointLines;
  for (const auto& [plain, of_nite] : {std::pair{"SpineBase", "JOINT_SPINE_BASE"},
                                       {"HIPLEFT", "JOINT_LEFT_HIP"},
                                       {"knee_left", "JOINT_LEFT_KNEE"},
                                       {"Head", "JOINT_HEAD"}}) {
    text = ReplacedAll(text, plain, of_nite);
  }
  ExpectLeg(ReadText(text));
}

// A row of joints in millimetres; commas between thousands must not become decimal points.
TEST(JointTables, WithCommasBetweenThousandsAreRefused) {
  const std::string header =
      "time_ms,Head_x,Head_y,Head_z,HipLeft_x,HipLeft_y,HipLeft_z,KneeLeft_x,KneeLeft_y,KneeLeft_"
      "z\n";
  for (const char* row : {"0,100,800,\"2,051\",100,200,\"2,000\",100,-200,\"2,000\"\n",
                          "0.5,100,800,\"2,051\",100,200,\"2,000\",100,-200,\"2,000\"\n"}) {
    test::ExpectRefused([&] { ReadText(header + row); }, "no comma between thousands");
  }
}

TEST(JointTables, WithDecimalCommasAreReadWhateverTheNumbers) {
  const std::string text =
      "time;Head_x;Head_y;Head_z;HipLeft_x;HipLeft_y;HipLeft_z;KneeLeft_x;KneeLeft_y;KneeLeft_z\n"
      "0,25;0,1;0,8;2;0,1;0,2;2;0,1;-0,2;2\n"
      "0,5;1,100;2,800;2,051;1,100;2,200;2,000;1,100;1,800;2,000\n";
  for (const std::string& table : {text, ReplacedAll(text, ";", "\t")}) {
    const auto read = ReadText(table);
    EXPECT_LT((At(read, 1, Joint::kHead) - Eigen::Vector3d(1.1, 2.8, 2.051)).norm(), 1e-12);
  }
}

TEST(JointTables, SeveralPeopleHaveTheirOwnJoints) {
  const auto read = ReadText(
      "frame,body,joint,x,y,z\n0,7,HipLeft,0.1,0.1,2\n0,7,KneeLeft,0.1,-0.3,2\n"
      "0,9,HipLeft,1,0.1,2\n0,9,KneeLeft,1,-0.3,2\n1,9,HipLeft,1,0.1,2\n1,9,KneeLeft,1,-0.3,2\n");
  ASSERT_EQ(read.frames.size(), 2u);
  ASSERT_EQ(read.frames[0].bodies.size(), 2u);
  ASSERT_EQ(read.frames[1].bodies.size(), 1u);
  EXPECT_EQ(read.frames[1].bodies[0].id, 2);
  EXPECT_EQ(read.frames[0].bodies[1].joints[Index(Joint::kHipLeft)]->position_m.x(), 1.0);
}

TEST(JointTables, NeckIsTheShoulderCenterOnlyIfThereIsNoOther) {
  const std::string with = kJointLines + "1 Neck 0.1 0.6 2\n1 SpineShoulder 0.1 0.5 2\n";
  EXPECT_NEAR(At(ReadText(with), 1, Joint::kShoulderCenter).y(), 0.5, 1e-12);
  EXPECT_FALSE(Tells(ReadText(with), "not read"));
  EXPECT_NEAR(At(ReadText(kJointLines + "1 Neck 0.1 0.6 2\n"), 1, Joint::kShoulderCenter).y(), 0.6,
              1e-12);
}

TEST(JointTables, MappingAddsOtherNames) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "names.txt") << "KneeLeft = Knie\nHipLeft = Huefte\n";
  SkeletonReadOptions options;
  options.mapping_file = folder / "names.txt";
  for (const std::string& text : {kJointLines, kJointColumns}) {
    std::string other = ReplacedAll(ReplacedAll(text, "knee_left", "Knie"), "KneeLeft", "Knie");
    other = ReplacedAll(ReplacedAll(other, "HIPLEFT", "Huefte"), "HipLeft", "Huefte");
    const auto read = ReadText(other, options);
    EXPECT_LT((At(read, 1, Joint::kKneeLeft) - Eigen::Vector3d(0.1, -0.3, 2)).norm(), 1e-12);
  }
}

struct Bad {
  const char* name;
  std::string text, told;
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadTables : public testing::TestWithParam<Bad> {};

TEST_P(BadTables, AreRefusedWithTheLineNumber) {
  const std::string line = ComplaintAbout(GetParam().text);
  EXPECT_NE(line.find("file: " + GetParam().told), std::string::npos) << line;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadTables,
    testing::Values(
        Bad{"Word", ReplacedAll(kJointLines, "0.101", "left"), "line 5: expected a finite number"},
        Bad{"Short", kJointLines + "2 Head 0.1 0.8\n", "line 9: expected FRAME JOINT x y z"},
        Bad{"Backwards", kJointLines + "0 Head 0.1 0.8 2\n",
            "line 9: expected frames or times that"},
        Bad{"Twice", kJointLines + "1 Head 0.1 0.8 2\n",
            "line 9: expected each joint once a frame"},
        Bad{"Confidence", kJointLines + "2 Head 0.1 0.8 2 7\n",
            "line 9: expected a confidence from"},
        Bad{"Column", ReplacedAll(kJointColumns, "2,open,\n5", "2\n5"),
            "line 2: expected 15 columns"},
        Bad{"Number", ReplacedAll(kJointColumns, "5.04", "late"),
            "line 3: expected a finite number"},
        Bad{"NoRows", kJointColumns.substr(0, kJointColumns.find('\n')),
            "expected at least one frame"},
        Bad{"Whose", ReplacedAll(kJointColumns, "time,", "body,"),
            "line 1: expected a column frame or"},
        Bad{"Names", "0 a 1 2 3\n0 b 1 2 3\n0 c 1 2 4\n",
            "joints: expected points named as joints"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace ossa::recon
