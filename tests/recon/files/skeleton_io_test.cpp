#include "recon/files/skeleton_io.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "depth/base/error.h"
#include "recon/files/skeleton_jsonl.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

// A millimetre file with four decimals keeps 5e-8 m; our table seven significant digits.
constexpr double kTolerance_m = 2e-6;

void ExpectSamePositions(const SkeletonSequence& a, const SkeletonSequence& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (size_t f = 0; f < a.frames.size(); ++f) {
    EXPECT_NEAR(a.frames[f].time_s, b.frames[f].time_s, kTolerance_m);
    ASSERT_EQ(a.frames[f].bodies.size(), b.frames[f].bodies.size());
    for (size_t j = 0; j < kJointCount; ++j) {
      const auto& one = a.frames[f].bodies[0].joints[j];
      const auto& other = b.frames[f].bodies[0].joints[j];
      ASSERT_EQ(one.has_value(), other.has_value()) << kJointNames[j];
      if (one) {
        EXPECT_LT((one->position_m - other->position_m).norm(), kTolerance_m);
      }
    }
  }
}

class EveryWrittenFormat : public testing::TestWithParam<const char*> {};

TEST_P(EveryWrittenFormat, IsFoundByContentAndReadBack) {
  const test::TemporaryFolder folder;
  const auto written = ExampleSequence(6);
  WriteSkeletons(folder / (std::string("walk") + GetParam()), written);
  // Under a name that says nothing.
  std::filesystem::rename(folder / (std::string("walk") + GetParam()), folder / "nameless");
  ExpectSamePositions(ReadSkeletons(folder / "nameless"), written);
}

INSTANTIATE_TEST_SUITE_P(All, EveryWrittenFormat, testing::Values(".jsonl", ".csv", ".trc"),
                         [](const auto& info) { return std::string(info.param + 1); });

// A table of blank rows must not become a person without joints, whom `ossa reconstruct` would
// invent.
TEST_P(EveryWrittenFormat, RecordingWithoutBodiesIsReadBack) {
  const test::TemporaryFolder folder;
  SkeletonSequence nobody = ExampleSequence(3);
  for (SkeletonFrame& frame : nobody.frames) frame.bodies.clear();
  WriteSkeletons(folder / (std::string("nobody") + GetParam()), nobody);
  const auto read = ReadSkeletons(folder / (std::string("nobody") + GetParam()));
  ASSERT_EQ(read.frames.size(), nobody.frames.size());
  for (const SkeletonFrame& frame : read.frames) EXPECT_TRUE(frame.bodies.empty());
}

// Rows are blank while a person is out of view.
TEST(TrcFile, KeepsABodyThatIsTemporarilyLost) {
  const test::TemporaryFolder folder;
  SkeletonSequence lost = ExampleSequence(3);
  lost.frames[1].bodies.clear();
  WriteSkeletons(folder / "lost.trc", lost);
  const auto read = ReadSkeletons(folder / "lost.trc");
  ASSERT_EQ(read.frames[1].bodies.size(), 1u);
  for (const auto& joint : read.frames[1].bodies[0].joints) EXPECT_FALSE(joint.has_value());
}

TEST(BvhFile, HoldsTheSamePostureWithConstantBones) {
  const test::TemporaryFolder folder;
  // A rigid figure has constant bones already: nothing is lost.
  SkeletonSequence stiff = ExampleSequence(8);
  for (auto& frame : stiff.frames) {
    for (size_t j = 0; j < kJointCount; ++j) {
      auto& joint = frame.bodies[0].joints[j];
      joint = JointRecord{};  // without a state: a joint that is not tracked has no place in BVH
      const auto i = static_cast<double>(j);
      joint->position_m = {0.02 * i, 0.1 * std::sin(i),
                           2 + 0.01 * static_cast<double>(frame.frame)};
    }
  }
  WriteSkeletons(folder / "walk.bvh", stiff);
  const auto read = ReadSkeletons(folder / "walk.bvh");
  ASSERT_EQ(read.frames.size(), stiff.frames.size());
  // BVH angles carry six decimals of a degree over chains of a metre.
  EXPECT_LT((At(read, 7, Joint::kHandLeft) - At(stiff, 7, Joint::kHandLeft)).norm(), 1e-4);
}

TEST(SkeletonFiles, UnknownExtensionIsRefusedBeforeWriting) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(WriteSkeletons(folder / "walk.xyz", ExampleSequence(1)), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// An independent reading of TRC: cells by tab, nothing shared with the reader under test.
std::vector<std::vector<std::string>> Cells(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    rows.emplace_back(1);
    for (const char c : line) {
      if (c == '\t') {
        rows.back().emplace_back();
      } else {
        rows.back().back().push_back(c);
      }
    }
  }
  return rows;
}

TEST(TrcFile, HasTheHeaderAndColumnsThatOpenSimExpects) {
  const test::TemporaryFolder folder;
  const auto sequence = ExampleSequence(4);
  WriteSkeletons(folder / "walk.trc", sequence);
  const auto rows = Cells(folder / "walk.trc");
  ASSERT_EQ(rows.size(), 6u + 4u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"PathFileType", "4", "(X/Y/Z)", "walk.trc"}));
  EXPECT_EQ(rows[1][4], "Units");
  EXPECT_EQ(rows[2][0], "30.000");
  EXPECT_EQ(rows[2][2], "4");
  EXPECT_EQ(rows[2][3], "20");
  EXPECT_EQ(rows[2][4], "mm");
  EXPECT_EQ(rows[3][2], "HipCenter");
  EXPECT_EQ(rows[3][5], "Spine");
  EXPECT_EQ(rows[4][2], "X1");
  EXPECT_EQ(rows[4][61], "Z20");
  EXPECT_EQ(rows[5], std::vector<std::string>{""});
  EXPECT_EQ(rows[6].size(), 62u);
  EXPECT_EQ(rows[6][0], "1");
  EXPECT_NEAR(std::stod(rows[7][4]), 1000 * At(sequence, 1, Joint::kHipCenter).z(), 1e-3);
  EXPECT_EQ(rows[6][2 + 3 * 7], "") << "a joint that is absent is a blank cell";
}

TEST(TrcFile, SeveralPeopleGiveAFileEach) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "two.trc", ExampleSequence(3, 2));
  const double apart = At(ReadSkeletons(folder / "two_2.trc"), 0, Joint::kHead).x() -
                       At(ReadSkeletons(folder / "two.trc"), 0, Joint::kHead).x();
  EXPECT_NEAR(apart, 1.0, kTolerance_m);
}

TEST(SkeletonClips, FoldersAreSortedByNameAndSkipOtherFiles) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "b");
  WriteSkeletons(folder / "b/two.jsonl", ExampleSequence(2));
  WriteSkeletons(folder / "a.csv", ExampleSequence(3));
  for (const char* other : {"README.txt", "Thumbs.db", "desktop.ini", "colour.mkv", "take.oni"}) {
    std::ofstream(folder / other) << "words";
  }
  const auto clips = ReadSkeletonClips(folder.path());
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].name, "a");
  EXPECT_EQ(clips[1].name, "b/two");
  EXPECT_THROW(ReadSkeletons(folder.path()), InputError) << "which of the two?";
  EXPECT_EQ(ReadSkeletons(folder.path().string() + "#two").frames.size(), 2u);
}

struct Wrong {
  const char* name;
  std::string text;
  std::string named;
};

void PrintTo(const Wrong& value, std::ostream* out) { *out << value.name; }

class WrongFile : public testing::TestWithParam<Wrong> {};

TEST_P(WrongFile, IsRefusedInOneLine) {
  const std::string complaint = ComplaintAbout(GetParam().text);
  EXPECT_TRUE(complaint.starts_with("file: line ")) << complaint;
  EXPECT_NE(complaint.find("expected"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find(GetParam().named), std::string::npos) << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

std::string ExampleText(const char* extension) {
  const test::TemporaryFolder folder;
  const auto path = folder / (std::string("walk") + extension);
  WriteSkeletons(path, ExampleSequence(3));
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string Replaced(std::string text, const std::string& old, const std::string& fresh) {
  const size_t place = text.find(old);
  if (place == std::string::npos) throw std::logic_error("nothing to replace: " + old);
  return text.replace(place, old.size(), fresh);
}

INSTANTIATE_TEST_SUITE_P(
    Plain, WrongFile,
    testing::Values(
        Wrong{"Empty", "", "empty file"}, Wrong{"Blank", " \n\n", "empty file"},
        Wrong{"BinaryJunk", std::string("\x01\x02\xff\x00\x7f", 5), "ossa knows"},
        Wrong{"Words", "hello\n", "'hello'"},
        Wrong{"OneEndlessLine", std::string(3 << 20, 'a'), "ossa knows"},
        Wrong{"CsvNan", Replaced(ExampleText(".csv"), "0.5", "nan"), "line 2"},
        Wrong{"CsvState", Replaced(ExampleText(".csv"), "not_tracked", "seen"),
              "tracked, inferred"},
        Wrong{"CsvColumns", ExampleText(".csv") + "4,0.2,1,3\n", "123 columns"},
        Wrong{"CsvHeader", Replaced(ExampleText(".csv"), "HipCenter_x", "SpineBase_x"), "header"},
        Wrong{"TrcUnits", Replaced(ExampleText(".trc"), "\tmm\t", "\tfurlongs\t"),
              "Units mm, cm, m or inches"},
        Wrong{"TrcInfinite", Replaced(ExampleText(".trc"), "2000.0000", "inf"), "line 7"},
        Wrong{"TrcMarkers", Replaced(ExampleText(".trc"), "\t20\tmm", "\t40\tmm"),
              "40 marker names"},
        Wrong{"TrcCut", ExampleText(".trc").substr(0, 60), "expected"},
        Wrong{"TrcEndlessLine", ExampleText(".trc") + std::string(2 << 20, '1'), "1 MiB"}),
    [](const testing::TestParamInfo<Wrong>& info) { return info.param.name; });

// A position of 1e300 m would give an infinite mean error.
TEST(SkeletonFiles, ImpossiblePositionIsRefusedWithFrameAndJoint) {
  std::string text = ExampleText(".jsonl");
  const size_t head = text.find("\"p\":[", text.find("\"Head\""));
  text.replace(head, text.find(']', head) - head, "\"p\":[0,1e300,0");
  EXPECT_EQ(ComplaintAbout(text),
            "file: frame 0: Head: expected a position within 1000 km, found 1e+300 m");
}

// Its header names the file, on one line.
TEST(SkeletonFiles, TrcIsRecognisedUnderAnyName) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "two\nlines\t.trc", ExampleSequence(3));
  ExpectSamePositions(ReadSkeletons(folder / "two\nlines\t.trc"), ExampleSequence(3));
}

// A text of frames with these times, in the format of this extension.
std::string ExampleTextAt(const char* extension, const std::vector<double>& times_s) {
  const test::TemporaryFolder folder;
  const auto path = folder / (std::string("walk") + extension);
  SkeletonSequence sequence = ExampleSequence(static_cast<int>(times_s.size()));
  for (size_t f = 0; f < times_s.size(); ++f) sequence.frames[f].time_s = times_s[f];
  WriteSkeletons(path, sequence);
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(SkeletonTimes, BackwardsOrLeapingTimesAreRefusedByLine) {
  struct Format {
    const char* extension;
    const char* line;
  };
  for (const auto& [extension, line] :
       {Format{".jsonl", "line 3"}, {".trc", "line 9"}, {".csv", "line 4"}}) {
    const std::string kThird = "0.234567";  // does not occur elsewhere; no writer lets it fall
    std::string fallen = ExampleTextAt(extension, {0, 0.2, std::stod(kThird), 0.3});
    fallen.replace(fallen.find(kThird), kThird.size(), "0.1");
    const std::string backwards = ComplaintAbout(fallen);
    EXPECT_NE(backwards.find(line), std::string::npos) << backwards;
    EXPECT_NE(backwards.find("expected times that grow, found '0.1 after 0.2'"), std::string::npos)
        << backwards;
    const std::string leaping = ComplaintAbout(ExampleTextAt(extension, {0, 0.1, 1e9, 1e9 + 1}));
    EXPECT_NE(leaping.find("at most a day after the frame before"), std::string::npos) << leaping;
  }
}

// Speeds and time alignment would be meaningless.
TEST(SkeletonTimes, ConstantTimesAreRefused) {
  for (const char* extension : {".jsonl", ".trc", ".csv"}) {
    EXPECT_EQ(ComplaintAbout(ExampleTextAt(extension, {1, 1, 1, 1})),
              "file: expected times that grow from frame to frame, found 3 of 4 frames at the time "
              "of the one before");
  }
}

// Loggers poll twice per sensor frame; clocks start anywhere; recordings may pause.
TEST(SkeletonTimes, MayRepeatOnceStartAnywhereAndPause) {
  for (const std::vector<double>& times_s : {std::vector<double>{0, 0, 0.1, 0.1},
                                             {-5, -4, 0, 1},
                                             {1.7e9, 1.7e9 + 0.1, 1.7e9 + 3600},
                                             {7}}) {
    EXPECT_EQ(ComplaintAbout(ExampleTextAt(".jsonl", times_s)), "") << times_s[0];
  }
}

// Written by Python's zipfile: "\xC3\xA4.jsonl" and "\xC3\xB6.jsonl", each with one empty frame.
constexpr std::string_view kZip =
    "504b0304140000080000000021002f1a36fd230000002300000008000000c3a42e6a736f6e6c7b226672616d"
    "65223a302c2274696d655f73223a302c22626f64696573223a5b5d7d0a504b0304140000080000000021002f"
    "1a36fd230000002300000008000000c3b62e6a736f6e6c7b226672616d65223a302c2274696d655f73223a30"
    "2c22626f64696573223a5b5d7d0a504b01021403140000080000000021002f1a36fd23000000230000000800"
    "00000000000000000000800100000000c3a42e6a736f6e6c504b01021403140000080000000021002f1a36fd"
    "2300000023000000080000000000000000000000800149000000c3b62e6a736f6e6c504b0506000000000200"
    "02006c000000920000000000";

// The same with "../x.jsonl" and with "/x.jsonl".
constexpr std::string_view kZipsThatLeadOut[] = {
    "504b0304140000000000000021002f1a36fd23000000230000000a0000002e2e2f782e6a736f6e6c7b226672"
    "616d65223a302c2274696d655f73223a302c22626f64696573223a5b5d7d0a504b0102140314000000000000"
    "0021002f1a36fd23000000230000000a00000000000000000000008001000000002e2e2f782e6a736f6e6c50"
    "4b05060000000001000100380000004b0000000000",
    "504b0304140000000000000021002f1a36fd2300000023000000080000002f782e6a736f6e6c7b226672616d"
    "65223a302c2274696d655f73223a302c22626f64696573223a5b5d7d0a504b01021403140000000000000021"
    "002f1a36fd23000000230000000800000000000000000000008001000000002f782e6a736f6e6c504b050600"
    "0000000100010036000000490000000000"};

void WriteBytes(const std::filesystem::path& path, std::string_view hex) {
  std::ofstream file(path, std::ios::binary);
  for (size_t i = 0; i < hex.size(); i += 2) {
    file.put(static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  }
}

// Without a UTF-8 locale libarchive has no name for either.
TEST(SkeletonArchives, MemberNamesMayBeNonAscii) {
  const test::TemporaryFolder folder;
  WriteBytes(folder / "x.zip", kZip);
  const auto clips = ReadSkeletonClips(folder / "x.zip");
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].name, "\xC3\xA4");
  EXPECT_EQ(clips[1].name, "\xC3\xB6");
}

// Results are written under the names of members.
TEST(SkeletonArchives, MembersOutsideTheArchiveAreRefused) {
  const test::TemporaryFolder folder;
  for (const std::string_view zip : kZipsThatLeadOut) {
    WriteBytes(folder / "x.zip", zip);
    test::ExpectRefused([&] { ReadSkeletonClips(folder / "x.zip"); }, "x.jsonl");
  }
}

// Otherwise results of one would overwrite those of the other.
TEST(SkeletonClips, KeepExtensionsThatDistinguishThem) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "a.csv", ExampleSequence(3));
  WriteSkeletons(folder / "a.jsonl", ExampleSequence(2));
  WriteSkeletons(folder / "b.jsonl", ExampleSequence(1));
  const auto clips = ReadSkeletonClips(folder.path());
  ASSERT_EQ(clips.size(), 3u);
  EXPECT_EQ(clips[0].name, "a.csv");
  EXPECT_EQ(clips[0].sequence.frames.size(), 3u);
  EXPECT_EQ(clips[1].name, "a.jsonl");
  EXPECT_EQ(clips[2].name, "b");
}

TEST(SkeletonClips, LinksKeepTheirNamesInTheFolder) {
  const test::TemporaryFolder folder;
  for (const char* name : {"elsewhere", "here"}) std::filesystem::create_directory(folder / name);
  for (const char* name : {"a.jsonl", "b.jsonl"}) {
    WriteSkeletons(folder / "elsewhere" / name, ExampleSequence(2));
    std::filesystem::create_symlink(folder / "elsewhere" / name, folder / "here" / name);
  }
  const auto clips = ReadSkeletonClips(folder / "here/");
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].name, "a");
  EXPECT_EQ(clips[1].name, "b");
}

}  // namespace
}  // namespace ossa::recon
