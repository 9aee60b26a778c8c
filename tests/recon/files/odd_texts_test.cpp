// Texts as programs really write them: line ends, tabs, counts, units, numbers that are none.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/recon/motion/figure.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// Two markers and a third that is no joint, millimetres, three frames.
const std::string kTrc =
    "PathFileType\t4\t(X/Y/Z)\tx.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
    "OrigNumFrames\n"
    "30\t30\t3\t2\tmm\t30\t1\t3\n"
    "Frame#\tTime\tLKnee\t\t\tHead\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
    "1\t0.00\t100.50\t500.25\t10.00\t0.00\t1600.00\t20.00\n"
    "2\t0.03\t110.50\t500.25\t10.00\t0.00\t1600.00\t20.00\n"
    "3\t0.06\t120.50\t500.25\t10.00\t0.00\t1600.00\t2.75\n";

void ExpectKneeAndHead(const SkeletonSequence& read, double size = 1.0) {
  ASSERT_EQ(read.frames.size(), 3u);
  EXPECT_LT((At(read, 1, Joint::kKneeLeft) - size * Eigen::Vector3d(0.1105, 0.50025, 0.01)).norm(),
            1e-9);
  EXPECT_LT((At(read, 2, Joint::kHead) - size * Eigen::Vector3d(0, 1.6, 0.00275)).norm(), 1e-9);
}

struct OddTrc {
  const char* name;
  std::string text;
  double size = 1.0;
};

void PrintTo(const OddTrc& odd, std::ostream* out) { *out << odd.name; }

class OddTrcs : public testing::TestWithParam<OddTrc> {};

TEST_P(OddTrcs, AreReadAsThePlainOne) {
  const auto read = ReadText(GetParam().text);
  ExpectKneeAndHead(read, GetParam().size);
  EXPECT_TRUE(read.warnings.empty()) << read.warnings.front();
}

INSTANTIATE_TEST_SUITE_P(
    All, OddTrcs,
    testing::Values(
        OddTrc{"Plain", kTrc}, OddTrc{"CrOnly", ReplacedAll(kTrc, "\n", "\r")},
        OddTrc{"CrLf", ReplacedAll(kTrc, "\n", "\r\n")},
        OddTrc{"ByteOrderMark", "\xEF\xBB\xBF" + kTrc},
        OddTrc{"LabelsFromX5", ReplacedAll(ReplacedAll(kTrc, "X1\tY1\tZ1", "X5\tY5\tZ5"),
                                           "X2\tY2\tZ2", "X6\tY6\tZ6")},
        OddTrc{"LabelsFromX0", ReplacedAll(ReplacedAll(kTrc, "X1\tY1\tZ1", "X0\tY0\tZ0"),
                                           "X2\tY2\tZ2", "X1\tY1\tZ1")},
        OddTrc{"Centimetres", ReplacedAll(kTrc, "\tmm\t", "\tcm\t"), 10.0},
        OddTrc{"Metres", ReplacedAll(kTrc, "\tmm\t", "\tm\t"), 1000.0},
        OddTrc{"CapitalMillimetres", ReplacedAll(kTrc, "\tmm\t", "\tMM\t")},
        OddTrc{"MetersWritten", ReplacedAll(kTrc, "\tmm\t", "\tMeters\t"), 1000.0},
        OddTrc{"Subject", ReplacedAll(ReplacedAll(kTrc, "LKnee", "Ann:LKnee"), "Head", "Ann:Head")},
        OddTrc{"DoubleTabsInTheKeys",
               ReplacedAll(kTrc, "CameraRate\tNumFrames", "CameraRate\t\tNumFrames")},
        OddTrc{"DoubleTabsInTheValues",
               ReplacedAll(kTrc, "30\t30\t3\t2\tmm", "30\t\t30\t\t3\t2\tmm")},
        OddTrc{"DoubleTabsInTheNames",
               ReplacedAll(kTrc, "Time\tLKnee\t\t\tHead", "Time\t\tLKnee\t\t\t\tHead")},
        OddTrc{"TabsAtTheEndOfRows", ReplacedAll(kTrc, "20.00\n", "20.00\t\t\n")},
        OddTrc{"NoLastLineEnd", kTrc.substr(0, kTrc.size() - 1)}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Trc, NanOfAnyProgramIsABlank) {
  for (const char* nan : {"NaN", "nan", "-nan", "-nan(ind)", "1.#QNAN", ""}) {
    const std::string gap = std::string(nan) + "\t" + nan + "\t" + nan;
    const auto read = ReadText(ReplacedAll(kTrc, "110.50\t500.25\t10.00", gap));
    const auto& joints = read.frames.at(1).bodies.at(0).joints;
    EXPECT_FALSE(joints[Index(Joint::kKneeLeft)].has_value()) << nan;
    EXPECT_TRUE(joints[Index(Joint::kHead)].has_value()) << nan;
  }
}

TEST(Trc, OfMoreOrFewerRowsThanItSaysIsWhatIsThereWithAWarning) {
  for (const char* said : {"\t2\t2\tmm", "\t9\t2\tmm"}) {
    const auto read = ReadText(ReplacedAll(kTrc, "\t3\t2\tmm", said));
    ExpectKneeAndHead(read);
    ASSERT_EQ(read.warnings.size(), 1u) << said;
    EXPECT_NE(read.warnings[0].find("the file has 3"), std::string::npos) << read.warnings[0];
  }
}

// Wherever it was cut: the digits that are missing would be another place.
TEST(Trc, CutInsideItsLastRowIsRefused) {
  const size_t row = kTrc.find("3\t0.06");
  for (size_t length = row + 1; length + 1 < kTrc.size(); ++length) {
    EXPECT_NE(ComplaintAbout(kTrc.substr(0, length)), "") << kTrc.substr(row, length - row);
  }
  EXPECT_EQ(ComplaintAbout(kTrc.substr(0, kTrc.size() - 1)), "");
}

// Some programs write z up; the format has y. The knee is below the hips here.
TEST(Trc, OfPeopleWhoStandAlongZIsTurnedUprightWithAWarning) {
  std::string text = ReplacedAll(kTrc, "\t3\t2\tmm", "\t3\t3\tmm");
  text = ReplacedAll(text, "\tHead\t\t", "\tHead\t\t\tPelvis\t\t");
  text = ReplacedAll(text, "X2\tY2\tZ2", "X2\tY2\tZ2\tX3\tY3\tZ3");
  for (const char* knee : {"100.50", "110.50", "120.50"}) {
    text = ReplacedAll(text, std::string(knee) + "\t500.25\t10.00",
                       std::string(knee) + "\t-900.00\t100.00");
  }
  text =
      ReplacedAll(text, "0.00\t1600.00\t20.00", "0.00\t-900.00\t1600.00\t0.00\t-900.00\t1000.00");
  text = ReplacedAll(text, "0.00\t1600.00\t2.75", "0.00\t-900.00\t1600.00\t0.00\t-900.00\t1000.00");
  const auto read = ReadText(text);
  EXPECT_LT((At(read, 0, Joint::kHead) - Eigen::Vector3d(0, 1.6, 0.9)).norm(), 1e-9);
  EXPECT_LT((At(read, 2, Joint::kKneeLeft) - Eigen::Vector3d(0.1205, 0.1, 0.9)).norm(), 1e-9);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_EQ(read.warnings[0], "file: the body stands along z: z is taken as up");
}

TEST(Trc, OfWhomNobodyStandsIsDoubted) {
  const std::string standing = ReplacedAll(kTrc, "LKnee", "Pelvis");
  EXPECT_TRUE(ReadText(standing).warnings.empty());
  const std::string lying = ReplacedAll(standing, "\t0.00\t1600.00\t", "\t1600.00\t500.00\t");
  const auto read = ReadText(lying);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("never stands along the axis taken as up"), std::string::npos);
}

TEST(Trc, OfTwoSubjectsIsTwoBodies) {
  const auto read =
      ReadText(ReplacedAll(ReplacedAll(kTrc, "LKnee", "Ann:LKnee"), "Head", "Bob:Head"));
  ASSERT_EQ(read.frames[0].bodies.size(), 2u);
  const auto has = [&](size_t body, Joint joint) {
    return read.frames[0].bodies[body].joints[Index(joint)].has_value();
  };
  EXPECT_TRUE(has(0, Joint::kKneeLeft));
  EXPECT_FALSE(has(0, Joint::kHead));
  EXPECT_TRUE(has(1, Joint::kHead));
}

const std::string kUnknownTrc = ReplacedAll(ReplacedAll(kTrc, "LKnee", "M01"), "Head", "M02");

TEST(Trc, WithoutKnownNamesSaysWhichItHasAndHowToMapThem) {
  const std::string complaint = ComplaintAbout(kUnknownTrc);
  EXPECT_NE(complaint.find("file: line 4: expected points named as joints"), std::string::npos);
  EXPECT_NE(complaint.find("found 'M01', 'M02': say in a file for --mapping"), std::string::npos)
      << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

// They are to be copied into a mapping.
TEST(Trc, NamesInAnyLanguageAreListedAsTheyAre) {
  std::string long_name;
  for (int i = 0; i < 30; ++i) long_name += "\u00FC";  // two bytes each
  const std::string text =
      ReplacedAll(ReplacedAll(kUnknownTrc, "M01", "H\u00FCfte"), "M02", long_name);
  const std::string complaint = ComplaintAbout(text);
  const std::string said = "found 'H\u00FCfte', '" + long_name.substr(0, 40) + "...'";
  EXPECT_NE(complaint.find(said), std::string::npos) << complaint;
}

TEST(Trc, WithAJointTwiceIsReadWithAWarningThatNamesTheOther) {
  const auto read = ReadText(ReplacedAll(kTrc, "Head", "L_Knee"));
  EXPECT_LT((At(read, 1, Joint::kKneeLeft) - Eigen::Vector3d(0.1105, 0.50025, 0.01)).norm(), 1e-9);
  ASSERT_FALSE(read.warnings.empty());
  EXPECT_NE(read.warnings.back().find("line 4: not read: 'L_Knee', for points before"),
            std::string::npos)
      << read.warnings.back();
}

TEST(Trc, WithFewKnownNamesIsReadWithAWarningThatListsAll) {
  const auto read = ReadText(ReplacedAll(kTrc, "Head", "M02"));
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("only 1 of the points are known"), std::string::npos);
  EXPECT_NE(read.warnings[0].find("'M02'"), std::string::npos) << read.warnings[0];
}

class MappedPoints : public testing::Test {
 protected:
  SkeletonReadOptions Mapping(const std::string& text) {
    std::ofstream(folder_ / "names.txt") << text;
    SkeletonReadOptions options;
    options.mapping_file = folder_ / "names.txt";
    return options;
  }
  ossa::test::TemporaryFolder folder_;
};

TEST_F(MappedPoints, AreJointsOrBonesAndTheMiddleOfSeveral) {
  ExpectKneeAndHead(ReadText(kUnknownTrc, Mapping("KneeLeft = M01\nHead=M02\n")));
  ExpectKneeAndHead(ReadText(kUnknownTrc, Mapping("LeftLeg = M01\nHead = M02\n")));
  const auto middle = ReadText(kUnknownTrc, Mapping("Spine = M01 + M02\n"));
  EXPECT_LT((At(middle, 0, Joint::kSpine) - Eigen::Vector3d(0.05025, 1.050125, 0.015)).norm(),
            1e-9);
}

TEST_F(MappedPoints, AreRefusedByTheLineThatNamesNone) {
  const auto options = Mapping("# of ours\nKneeLeft = M01\nHead = M03\n");
  ossa::test::ExpectRefused([&] { ReadText(kUnknownTrc, options); },
                            "names.txt: line 3: expected a point of file, found 'M03'");
}

TEST_F(MappedPoints, OfAC3dAreReadLikewise) {
  const std::string text = ReplacedAll(C3dBytes(), "HipCenter Head", "Ball      Hat ");
  const std::string complaint = ComplaintAbout(text);
  EXPECT_NE(complaint.find("found 'Ball', 'Hat'"), std::string::npos) << complaint;
  const auto read = ReadText(text, Mapping("HipCenter = Ball\nHead = Hat\n"));
  EXPECT_LT((At(read, 0, Joint::kHead) - At(ReadText(C3dBytes()), 0, Joint::kHead)).norm(), 1e-12);
}

/// The number of the other processor's bytes for the same values.
std::string ForMips(std::string bytes) {
  const auto swap = [&](size_t at, size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  };
  for (const size_t word : {2U, 6U, 8U, 16U}) swap(word, 2);
  for (const size_t real : {12U, 20U}) swap(real, 4);
  for (size_t at = 1024; at + 4 <= 1024 + 3 * 2 * 16; at += 4) swap(at, 4);
  for (const char* name : {"POINT", "LABELS", "UNITS"}) {
    swap(bytes.find(name, 512) + std::string(name).size(), 2);
  }
  bytes[512 + 3] = 86;
  return bytes;
}

std::string ForDec(std::string bytes) {
  const auto convert = [&](size_t at) {
    float value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    value *= 4;
    std::memcpy(bytes.data() + at, &value, 4);
    std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + 2),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + 2));
  };
  for (const size_t real : {12U, 20U}) convert(real);
  for (size_t at = 1024; at + 4 <= 1024 + 3 * 2 * 16; at += 4) convert(at);
  bytes[512 + 3] = 85;
  return bytes;
}

TEST(C3d, OfEveryProcessorIsTheSame) {
  const auto intel = ReadText(C3dBytes());
  for (const std::string& bytes : {ForMips(C3dBytes()), ForDec(C3dBytes())}) {
    const auto read = ReadText(bytes);
    ASSERT_EQ(read.frames.size(), intel.frames.size());
    EXPECT_NEAR(read.frames[1].time_s, 0.02, 1e-9);
    for (size_t f = 0; f < 2; ++f) {
      for (const Joint joint : {Joint::kHipCenter, Joint::kHead}) {
        EXPECT_LT((At(read, f, joint) - At(intel, f, joint)).norm(), 1e-9);
      }
    }
    EXPECT_FALSE(read.frames[2].bodies[0].joints[3].has_value()) << "not seen";
  }
}

TEST(C3d, NanIsNotSeen) {
  std::string bytes = C3dBytes();
  Put<float>(bytes, 1024 + 16, std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(ReadText(bytes).frames[0].bodies[0].joints[3].has_value());
}

std::string OwnCsv() {
  const ossa::test::TemporaryFolder folder;
  WriteSkeletons(folder / "x.csv", ExampleSequence(3));
  std::ifstream file(folder / "x.csv");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// As a spreadsheet in quotes: every field.
std::string InQuotes(const std::string& text, char separator) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == separator || c == '\n') {
      quoted.append("\"").append(1, c).append("\"");
    } else {
      quoted.push_back(c);
    }
  }
  quoted.pop_back();
  return quoted;
}

TEST(OwnCsv, AsSpreadsheetsSaveItIsTheSame) {
  const std::string own = OwnCsv();
  std::string european = ReplacedAll(own, ",", ";");
  european = ReplacedAll(european, ".", ",");
  for (const std::string& text :
       {european, ReplacedAll(own, ",", "\t"), InQuotes(own, ','), InQuotes(european, ';'),
        "\xEF\xBB\xBF" + ReplacedAll(european, "\n", "\r\n"), ReplacedAll(own, "\n", ",,,\n"),
        InQuotes(ReplacedAll(ReplacedAll(ReplacedAll(own, ",", "|"), ".", ","), "\n", "|\n"),
                 '|')}) {
    const std::string table = ReplacedAll(text, "|", ",");
    const auto read = ReadText(table);
    const auto plain = ReadText(own);
    ASSERT_EQ(read.frames.size(), plain.frames.size());
    for (size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(At(read, f, Joint::kHead), At(plain, f, Joint::kHead));
      EXPECT_EQ(read.frames[f].time_s, plain.frames[f].time_s);
    }
  }
}

TEST(OwnCsv, RowsOfSeparatorsAloneArePassedOver) {
  const std::string own = OwnCsv();
  for (const char* rows : {",,,,\n", ",\n,\n"}) {
    EXPECT_EQ(ReadText(own + rows).frames.size(), ReadText(own).frames.size());
  }
}

TEST(OwnCsv, CutInsideARowIsRefused) {
  const std::string own = OwnCsv();
  EXPECT_NE(ComplaintAbout(own.substr(0, own.rfind(','))), "");
}

TEST(Ntu, WithNanKeepsTheOtherJoints) {
  const auto read = ReadText(ReplacedAll(NtuText(), "0 0 3 277", "NaN NaN NaN 277"));
  ASSERT_EQ(read.frames.size(), 2u);
  size_t joints = 0;
  for (const auto& joint : read.frames[1].bodies.at(0).joints) joints += joint ? 1 : 0;
  EXPECT_GE(joints, 18u);
}

TEST(Ntu, WithWrongCountsKeepsWhatIsThereWithAWarning) {
  const std::string good = NtuText();
  for (const std::string& text :
       {ReplacedAll(good, "2\n0\n1\n", "7\n0\n1\n"), ReplacedAll(good, "2\n0\n1\n", "1\n0\n1\n"),
        ReplacedAll(good, "2\n0\n1\n", "2\n0\n3\n"), ReplacedAll(good, "2\n0\n1\n", "2\n2\n1\n"),
        ReplacedAll(good, "2\n0\n1\n", "2\n0\n0\n")}) {
    const auto read = ReadText(text);
    ASSERT_EQ(read.frames.size(), 2u);
    EXPECT_TRUE(read.frames[0].bodies.empty());
    EXPECT_EQ(read.frames[1].bodies.size(), 1u);
    EXPECT_NE(read.warnings.at(0).find("count"), std::string::npos) << read.warnings[0];
  }
}

TEST(OddText, InUtf16IsRefusedByThatName) {
  EXPECT_NE(ComplaintAbout(std::string("\xFF\xFE"
                                       "f\0r\0",
                                       6))
                .find("found UTF-16"),
            std::string::npos);
}

struct OddBvh {
  const char* name;
  std::string text;
  const char* warning;  // "" for none
};

void PrintTo(const OddBvh& odd, std::ostream* out) { *out << odd.name; }

class OddBvhs : public testing::TestWithParam<OddBvh> {};

TEST_P(OddBvhs, AreReadAsThePlainOne) {
  const auto plain = ReadText(test::FigureBvh());
  const auto read = ReadText(GetParam().text);
  ASSERT_EQ(read.frames.size(), plain.frames.size());
  for (const size_t f : {size_t{0}, plain.frames.size() - 1}) {
    EXPECT_EQ(At(read, f, Joint::kHandLeft), At(plain, f, Joint::kHandLeft));
  }
  const std::string warning = GetParam().warning;
  ASSERT_EQ(read.warnings.empty(), warning.empty());
  if (!warning.empty()) {
    EXPECT_NE(read.warnings[0].find(warning), std::string::npos) << read.warnings[0];
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, OddBvhs,
    testing::Values(
        OddBvh{"CrOnly", ReplacedAll(test::FigureBvh(), "\n", "\r"), ""},
        OddBvh{"CrLf", ReplacedAll(test::FigureBvh(), "\n", "\r\n"), ""},
        OddBvh{"ByteOrderMark", "\xEF\xBB\xBF" + test::FigureBvh(), ""},
        OddBvh{"LowerCase", ReplacedAll(test::FigureBvh(), "HIERARCHY", "hierarchy"), ""},
        OddBvh{
            "NoSpaceAfterColons",
            ReplacedAll(ReplacedAll(test::FigureBvh(), "Frames: ", "Frames:"), "Time: ", "Time:"),
            ""},
        OddBvh{"SpaceBeforeColons", ReplacedAll(test::FigureBvh(), "Frames:", "Frames :"), ""},
        OddBvh{"EndSiteChannels0",
               ReplacedAll(test::FigureBvh(), "0.000000\n}", "0.000000\nCHANNELS 0\n}"), ""},
        OddBvh{"MoreFramesSaid", ReplacedAll(test::FigureBvh(), "Frames: 30", "Frames: 75"),
               "the header says 75 frames, the file has 30"},
        OddBvh{"FewerFramesSaid", ReplacedAll(test::FigureBvh(), "Frames: 30", "Frames: 7"),
               "the header says 7 frames, the file has 30"},
        OddBvh{"FramesASecondForATime", ReplacedAll(test::FigureBvh(), "0.0333333", "30"),
               "Frame Time says 30 s a frame"},
        OddBvh{"NoLastLineEnd", test::FigureBvh().substr(0, test::FigureBvh().size() - 1), ""}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(OddBvh, CutInsideItsLastRowIsRefused) {
  const std::string whole = test::FigureBvh();
  const size_t row = whole.rfind('\n', whole.size() - 2);
  for (size_t length = row + 3; length + 1 < whole.size(); length += 7) {
    EXPECT_NE(ComplaintAbout(whole.substr(0, length)), "") << length - row;
  }
  EXPECT_NE(ComplaintAbout(whole.substr(0, whole.size() - 2)), "") << "its last digit";
}

TEST(TrcUnits, OfAnotherThanTheFileIsInAreToldOf) {
  const ossa::test::TemporaryFolder folder;
  WriteSkeletons(folder / "x.trc", ExampleSequence(5));
  std::ifstream file(folder / "x.trc");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto tells = [](const SkeletonSequence& read) {
    return std::any_of(read.warnings.begin(), read.warnings.end(), [](const std::string& warning) {
      return warning.find("m long, which are no person's") != std::string::npos;
    });
  };
  EXPECT_FALSE(tells(ReadText(text)));
  EXPECT_TRUE(tells(ReadText(ReplacedAll(text, "\tmm\t", "\tm\t"))));
}

struct Foreign {
  const char* name;
  std::string text, told;
};

void PrintTo(const Foreign& foreign, std::ostream* out) { *out << foreign.name; }

class ForeignRecordings : public testing::TestWithParam<Foreign> {};

TEST_P(ForeignRecordings, AreRefusedByNameAndWithAWay) {
  try {
    ReadText(GetParam().text);
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find("found " + GetParam().told), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

using namespace std::string_literals;

INSTANTIATE_TEST_SUITE_P(
    OfOtherPrograms, ForeignRecordings,
    testing::Values(
        Foreign{"Fbx", "Kaydara FBX Binary  \x00\x1a\x00"s, "FBX: export it as BVH"},
        Foreign{"FbxText", "; FBX 7.3.0 project file\n", "FBX: export it as BVH"},
        Foreign{"Mvnx", "<?xml version=\"1.0\"?>\n<mvnx version=\"4\">\n",
                "Xsens MVN's XML: export"},
        Foreign{"Motive", "Format Version,1.23,Take Name,a,Capture Frame Rate,120\n\n,,Bone\n",
                "OptiTrack Motive's CSV: export it as BVH"},
        Foreign{"Vicon", "Trajectories\n100\n,,LASI,,\nFrame,Sub Frame,X,Y,Z\n",
                "Vicon Nexus' CSV"},
        Foreign{"OpenPose", R"({"version":1.3,"people":[{"pose_keypoints_2d":[1,2,0.9]}]})",
                "2D key points (OpenPose): they lie in the image"},
        Foreign{"Coco", R"([{"image_id":1,"keypoints":[1,2,1]}])", "2D key points (COCO)"},
        Foreign{"MediaPipe", R"([{"landmarks":[{"x":0.5,"y":0.5,"z":0,"visibility":1}]}])",
                "MediaPipe's landmarks: write it as ossa's JSONL"},
        Foreign{"Named", R"([{"SpineBase":[0.1,0.2,2.0],"SpineMid":[0.1,0.5,2.0]}])",
                "joints by name: write it as ossa's JSONL"},
        Foreign{"Pickle", "\x80\x04\x95 poses", "a Python pickle"},
        Foreign{"Array", "\x93NUMPY\x01", "a NumPy array: write"},
        Foreign{"Unknown", "plain words\n", "'plain words'"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace ossa::recon
