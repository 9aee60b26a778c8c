// TRC files as programs really write them: line ends, tabs, counts, units, axes, names.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
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

TEST_P(OddTrcs, AreReadLikeThePlainFile) {
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

TEST(Trc, NanInAnySpellingIsMissing) {
  for (const char* nan : {"NaN", "nan", "-nan", "-nan(ind)", "1.#QNAN", ""}) {
    const std::string gap = std::string(nan) + "\t" + nan + "\t" + nan;
    const auto read = ReadText(ReplacedAll(kTrc, "110.50\t500.25\t10.00", gap));
    const auto& joints = read.frames.at(1).bodies.at(0).joints;
    EXPECT_FALSE(joints[Index(Joint::kKneeLeft)].has_value()) << nan;
    EXPECT_TRUE(joints[Index(Joint::kHead)].has_value()) << nan;
  }
}

TEST(Trc, TheOriginAndMotionAnalysissNumberAreBlanks) {
  for (const char* unseen : {"0.00\t0.00\t0.00\n", "9999999.00\t9999999.00\t9999999.00\n"}) {
    const auto read = ReadText(ReplacedAll(kTrc, "0.00\t1600.00\t2.75\n", unseen));
    EXPECT_FALSE(read.frames[2].bodies[0].joints[Index(Joint::kHead)]) << unseen;
    EXPECT_TRUE(read.frames[1].bodies[0].joints[Index(Joint::kHead)]) << unseen;
  }
}

// Skeletons relative to a joint have it at the origin in every row; far from the others it is none.
TEST(Trc, APointAtTheOriginInAllRowsIsOneIfTheOthersAreAroundIt) {
  std::string at_origin = ReplacedAll(kTrc, "0.00\t1600.00\t20.00\n", "0.00\t0.00\t0.00\n");
  at_origin = ReplacedAll(at_origin, "0.00\t1600.00\t2.75\n", "0.00\t0.00\t0.00\n");
  at_origin = ReplacedAll(at_origin, "\t500.25", "\t200.25");
  const auto has_head = [](const SkeletonSequence& read) {
    return read.frames[1].bodies[0].joints[Index(Joint::kHead)].has_value();
  };
  EXPECT_TRUE(has_head(ReadText(at_origin)));
  for (const char* farther : {"\t500.25", "\t2200.25"}) {
    EXPECT_FALSE(has_head(ReadText(ReplacedAll(at_origin, "\t200.25", farther)))) << farther;
  }
}

TEST(Trc, WrongRowCountKeepsTheRowsWithAWarning) {
  for (const char* said : {"\t2\t2\tmm", "\t9\t2\tmm"}) {
    const auto read = ReadText(ReplacedAll(kTrc, "\t3\t2\tmm", said));
    ExpectKneeAndHead(read);
    ASSERT_EQ(read.warnings.size(), 1u) << said;
    EXPECT_NE(read.warnings[0].find("the file has 3"), std::string::npos) << read.warnings[0];
  }
}

// Missing digits would give another position.
TEST(Trc, WarnsIfTimesAndRateDisagree) {
  std::string text = ReplacedAll(kTrc, "\t0.03\t", "\t33.3\t");
  const auto read = ReadText(ReplacedAll(text, "\t0.06\t", "\t66.7\t"));
  EXPECT_EQ(read.frames[2].time_s, 66.7);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("DataRate says 30 frames a second, the times are those of 0.03"),
            std::string::npos)
      << read.warnings[0];
}

TEST(Trc, TruncatedLastRowIsRefused) {
  const size_t row = kTrc.find("3\t0.06");
  for (size_t length = row + 1; length + 1 < kTrc.size(); ++length) {
    EXPECT_NE(ComplaintAbout(kTrc.substr(0, length)), "") << kTrc.substr(row, length - row);
  }
  EXPECT_EQ(ComplaintAbout(kTrc.substr(0, kTrc.size() - 1)), "");
}

// Some programs write z up; the format's up axis is y. Here the knee is below the hips.
TEST(Trc, ZUpIsConvertedWithAWarning) {
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

TEST(Trc, WarnsIfNobodyStandsUpright) {
  const std::string standing = ReplacedAll(kTrc, "LKnee", "Pelvis");
  EXPECT_TRUE(ReadText(standing).warnings.empty());
  const std::string lying = ReplacedAll(standing, "\t0.00\t1600.00\t", "\t1600.00\t500.00\t");
  const auto read = ReadText(lying);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("never stands along the axis taken as up"), std::string::npos);
}

TEST(Trc, TwoSubjectsAreTwoBodies) {
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

TEST(Trc, NoKnownNamesAreRefusedWithAListAndTheMappingOption) {
  const std::string complaint = ComplaintAbout(kUnknownTrc);
  EXPECT_NE(complaint.find("file: line 4: expected points named as joints"), std::string::npos);
  EXPECT_NE(complaint.find("found 'M01', 'M02': say in a file for --mapping"), std::string::npos)
      << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

// Users copy them into a mapping.
TEST(Trc, NamesInAnyLanguageAreListedAsTheyAre) {
  std::string long_name;
  for (int i = 0; i < 30; ++i) long_name += "\u00FC";  // two bytes each
  const std::string text =
      ReplacedAll(ReplacedAll(kUnknownTrc, "M01", "H\u00FCfte"), "M02", long_name);
  const std::string complaint = ComplaintAbout(text);
  const std::string said = "found 'H\u00FCfte', '" + long_name.substr(0, 40) + "...'";
  EXPECT_NE(complaint.find(said), std::string::npos) << complaint;
}

TEST(Trc, DuplicatedJointGivesAWarning) {
  const auto read = ReadText(ReplacedAll(kTrc, "Head", "L_Knee"));
  EXPECT_LT((At(read, 1, Joint::kKneeLeft) - Eigen::Vector3d(0.1105, 0.50025, 0.01)).norm(), 1e-9);
  ASSERT_FALSE(read.warnings.empty());
  EXPECT_NE(read.warnings.back().find("line 4: not read: 'L_Knee', for points before"),
            std::string::npos)
      << read.warnings.back();
}

TEST(Trc, FewKnownNamesGiveAWarningThatListsAll) {
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

TEST_F(MappedPoints, AreJointsBonesOrMidpoints) {
  ExpectKneeAndHead(ReadText(kUnknownTrc, Mapping("KneeLeft = M01\nHead=M02\n")));
  ExpectKneeAndHead(ReadText(kUnknownTrc, Mapping("LeftLeg = M01\nHead = M02\n")));
  const auto middle = ReadText(kUnknownTrc, Mapping("Spine = M01 + M02\n"));
  EXPECT_LT((At(middle, 0, Joint::kSpine) - Eigen::Vector3d(0.05025, 1.050125, 0.015)).norm(),
            1e-9);
}

TEST_F(MappedPoints, UnknownPointIsRefusedWithTheMappingsLine) {
  const auto options = Mapping("# of ours\nKneeLeft = M01\nHead = M03\n");
  ossa::test::ExpectRefused([&] { ReadText(kUnknownTrc, options); },
                            "names.txt: line 3: expected a point of file, found 'M03'");
}

TEST_F(MappedPoints, MapC3dPointsToo) {
  const std::string text = ReplacedAll(C3dBytes(), "HipCenter Head", "Ball      Hat ");
  const std::string complaint = ComplaintAbout(text);
  EXPECT_NE(complaint.find("found 'Ball', 'Hat'"), std::string::npos) << complaint;
  const auto read = ReadText(text, Mapping("HipCenter = Ball\nHead = Hat\n"));
  EXPECT_LT((At(read, 0, Joint::kHead) - At(ReadText(C3dBytes()), 0, Joint::kHead)).norm(), 1e-12);
}

TEST(TrcUnits, WrongUnitsGiveAWarning) {
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

}  // namespace
}  // namespace ossa::recon
