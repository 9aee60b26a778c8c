#include "recon/fuse/extrinsics.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "tests/recon/fuse/moving_people.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

Extrinsics TwoCameras() { return {{.name = "front"}, {"side \"2\"", test::FromTheSide(), -0.125}}; }

class ExtrinsicsFile : public testing::Test {
 protected:
  // The error of reading the text after one replacement; "" if it is read.
  std::string Said(const std::string& from, const std::string& to) {
    std::string text = ExtrinsicsJson(TwoCameras());
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    std::ofstream(file_) << text;
    try {
      ReadExtrinsics(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  ossa::test::TemporaryFolder folder_;
  std::string file_ = folder_ / "room.json";
};

TEST_F(ExtrinsicsFile, ReadsWhatItWrote) {
  WriteExtrinsics(file_, TwoCameras());
  const Extrinsics read = ReadExtrinsics(file_);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[1].name, "side \"2\"");
  EXPECT_EQ(read[1].clock_offset_s, -0.125);
  // Nine digits are written.
  EXPECT_TRUE(read[1].from_camera_0.isApprox(test::FromTheSide(), 1e-8));
  EXPECT_TRUE(read[0].from_camera_0.matrix().isIdentity(0.0));
}

TEST_F(ExtrinsicsFile, KeepsTheOffsetOfAClockThatCountsFrom1970) {
  Extrinsics cameras = TwoCameras();
  cameras[1].clock_offset_s = -1699999999.3;
  WriteExtrinsics(file_, cameras);
  // A microsecond is written.
  EXPECT_NEAR(ReadExtrinsics(file_)[1].clock_offset_s, cameras[1].clock_offset_s, 1e-6);
}

TEST_F(ExtrinsicsFile, RefusesOneDamagedField) {
  const std::vector<std::pair<std::pair<std::string, std::string>, std::string>> cases = {
      {{"{\n  \"cam", "[{\n  \"cam"}, "a JSON object"},
      {{"\"cameras\"", "\"camera\""}, "expected \"cameras\""},
      {{"\"side \\\"2\\\"\"", "\"front\""}, "cameras[1].name: expected a name of its own"},
      {{"\"front\"", "7"}, "cameras[0].name: expected a name"},
      {{"\"front\"", "\"\""}, "cameras[0].name: expected a name"},
      {{"\"from_camera_0\"", "\"from\""}, "cameras[0]: expected \"from_camera_0\""},
      {{"-0.125", "null"}, "cameras[1].clock_offset_s: expected a number"},
      {{"-0.125", "1e999"}, "a JSON object"},
      {{"[1, 0, 0, 0]", "[1, 0, 0]"}, "cameras[0].from_camera_0: expected 4 rows of 4 numbers"},
      {{"[1, 0, 0, 0]", "[1, 0, 0, \"x\"]"}, "from_camera_0[0][3]: expected a number"},
      {{"[1, 0, 0, 0]", "[1, 0, 0, 2e6]"}, "from_camera_0[0][3]: expected a number within 1e+06"},
      {{"[1, 0, 0, 0]", "[2, 0, 0, 0]"}, "expected a rotation"},
      {{"[1, 0, 0, 0]", "[-1, 0, 0, 0]"}, "expected a rotation"},
      {{"[0, 0, 0, 1]", "[0, 0, 1, 1]"}, "expected 0 0 0 1 as its last row"},
      {{"[1, 0, 0, 0]", "[1, 0, 0, 0.5]"}, "cameras[0]: expected camera 0 first"},
      {{"\"clock_offset_s\": 0\n", "\"clock_offset_s\": 1\n"}, "expected camera 0 first"}};
  for (const auto& [change, said] : cases) {
    const std::string found = Said(change.first, change.second);
    EXPECT_NE(found.find(said), std::string::npos) << change.second << ": " << found;
    EXPECT_TRUE(found.starts_with(file_)) << found;
  }
}

TEST_F(ExtrinsicsFile, RefusesAMissingFileAndOneOfBracketsOnly) {
  EXPECT_THROW(ReadExtrinsics(folder_ / "none.json"), InputError);
  std::ofstream(file_) << std::string(1000, '[');
  EXPECT_THROW(ReadExtrinsics(file_), InputError);
}

TEST(Extrinsics, OfNamedCamerasAreRelativeToTheFirstNamed) {
  Extrinsics three = TwoCameras();
  three[1].name = "side";
  three.push_back({"back", test::FromTheSide() * test::FromTheSide(), 0.5});
  const std::vector<std::string> names = {"back", "side"};
  const Extrinsics selected = SelectCameras(three, names, "room.json");
  ASSERT_EQ(selected.size(), 2u);
  EXPECT_TRUE(selected[0].from_camera_0.matrix().isIdentity(0.0));
  EXPECT_EQ(selected[0].clock_offset_s, 0.0);
  // side from back = side from 0, 0 from back.
  EXPECT_TRUE(selected[1].from_camera_0.isApprox(test::FromTheSide().inverse(), 1e-12));
  EXPECT_EQ(selected[1].clock_offset_s, -0.125 - 0.5);
}

TEST(Extrinsics, UnknownNamesAreMatchedInOrderIfTheNumbersAgree) {
  const std::vector<std::string> two = {"a", "b"}, three = {"a", "b", "c"};
  EXPECT_EQ(SelectCameras(TwoCameras(), two, "room.json")[1].name, "side \"2\"");
  EXPECT_THROW(SelectCameras(TwoCameras(), three, "room.json"), InputError);
}

TEST(Extrinsics, RecordingNamedLikeACameraGetsThatCamera) {
  const std::vector<std::string> swapped = {"side \"2\"", "b"}, in_order = {"front", "b"};
  EXPECT_EQ(SelectCameras(TwoCameras(), in_order, "room.json")[1].name, "side \"2\"");
  try {
    SelectCameras(TwoCameras(), swapped, "room.json");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("room.json: cameras[0]: expected the camera of"), 0u)
        << error.what();
  }
}

TEST(Extrinsics, CameraNamesAreStemsOfFilesAndFolders) {
  const std::vector<std::string> different = {"clip/camera_0/", "b.jsonl"};
  EXPECT_EQ(CameraNames(different), (std::vector<std::string>{"camera_0", "b"}));
  const std::vector<std::string> alike = {"left/me.jsonl", "right/me.jsonl"};
  EXPECT_EQ(CameraNames(alike), (std::vector<std::string>{"camera_0", "camera_1"}));
}

}  // namespace
}  // namespace ossa::recon
