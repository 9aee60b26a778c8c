// Texts as programs really write them: processors, quotes, counts, encodings, NaN, other formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/recon/motion/figure.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// Converts the numbers to another processor's format.
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

TEST(C3d, ReadsAllProcessorFormatsEqually) {
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

TEST(C3d, NanIsAMissingPoint) {
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

/// Quotes every field, as some spreadsheets do.
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

TEST(OwnCsv, SpreadsheetVariantsAreEqual) {
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

TEST(OwnCsv, RowsOfSeparatorsOnlyAreSkipped) {
  const std::string own = OwnCsv();
  for (const char* rows : {",,,,\n", ",\n,\n"}) {
    EXPECT_EQ(ReadText(own + rows).frames.size(), ReadText(own).frames.size());
  }
}

TEST(OwnCsv, TruncatedRowIsRefused) {
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

TEST(Ntu, WrongCountsKeepTheExistingDataWithAWarning) {
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

TEST(OddText, Utf16IsRefusedByName) {
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

TEST_P(OddBvhs, AreReadLikeThePlainFile) {
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

TEST(OddBvh, TruncatedLastRowIsRefused) {
  const std::string whole = test::FigureBvh();
  const size_t row = whole.rfind('\n', whole.size() - 2);
  for (size_t length = row + 3; length + 1 < whole.size(); length += 7) {
    EXPECT_NE(ComplaintAbout(whole.substr(0, length)), "") << length - row;
  }
  EXPECT_NE(ComplaintAbout(whole.substr(0, whole.size() - 2)), "") << "its last digit";
}

struct Foreign {
  const char* name;
  std::string text, told;
};

void PrintTo(const Foreign& foreign, std::ostream* out) { *out << foreign.name; }

class ForeignRecordings : public testing::TestWithParam<Foreign> {};

TEST_P(ForeignRecordings, AreRefusedByNameWithAWayToConvertThem) {
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
        Foreign{"Xz",
                "\xFD"
                "7zXZ\0\0\x04",
                "a packed file (xz): unpack it"},
        Foreign{"Mot",
                "Coordinates\nversion=1\nnRows=2\nnColumns=3\nendheader\ntime\tpelvis_tilt\n",
                "an OpenSim table (MOT or STO): export its markers as TRC"},
        Foreign{"JsonArray", R"([{"frame":0,"time_s":0,"bodies":[]}])",
                "a JSON array of frames: write an object a frame"},
        Foreign{"PrettyJson", "{\n \"frame\": 0,\n \"bodies\": []\n}\n",
                "JSON over several lines: write an object a frame"},
        Foreign{"Array", "\x93NUMPY\x01", "a NumPy array: write"},
        Foreign{"Unknown", "plain words\n", "'plain words'"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace ossa::recon
