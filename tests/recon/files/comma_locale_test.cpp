// Numbers in files have a decimal point in every locale.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "depth/image/camera_io.h"
#include "depth/sensor/fakenect_dump.h"
#include "recon/files/skeleton_io.h"
#include "recon/fuse/extrinsics.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/support/comma_locale.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::CommaLocale;

/// Files of a folder, by name.
using Files = std::map<std::string, std::string>;

Files FilesIn(const std::filesystem::path& folder) {
  Files files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    files[entry.path().filename()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return files;
}

/// All file formats of recon and depth that contain numbers.
Files WrittenNow() {
  const test::TemporaryFolder folder;
  for (const char* name : {"x.jsonl", "x.csv", "x.trc", "x.bvh", "x.glb"}) {
    WriteSkeletons(folder / name, ExampleSequence(5));
  }
  depth::DepthFrame frame = test::ExampleFrame(0, 640, 480);
  frame.time_s = 0.5;
  depth::WriteCameraJson(folder / "camera.json", frame.camera);
  WriteExtrinsics(folder / "extrinsics.json",
                  {{.name = "a"}, {.name = "b", .clock_offset_s = 0.25}});
  Files files = FilesIn(folder.path());
  depth::FakenectDump dump(folder / "dump", frame.camera);
  dump.Write(frame);
  dump.Finish();
  files.merge(FilesIn(folder / "dump"));
  return files;
}

TEST(CommaLocale, AffectsTheStandardFunctions) {
  const CommaLocale locale;
  if (!locale.is_there()) GTEST_SKIP() << "no German locale can be made here";
  EXPECT_EQ(std::stod("1,5"), 1.5);
  EXPECT_EQ((std::ostringstream() << 1.5).str(), "1,5");
}

TEST(CommaLocale, DoesNotAffectWriting) {
  const Files expected = WrittenNow();
  const CommaLocale locale;
  if (!locale.is_there()) GTEST_SKIP() << "no German locale can be made here";
  const Files found = WrittenNow();
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [name, bytes] : expected) {
    ASSERT_EQ(found.count(name), 1U) << name;
    EXPECT_EQ(found.at(name), bytes) << name;
  }
}

TEST(CommaLocale, DoesNotAffectReading) {
  const test::TemporaryFolder folder;
  for (const auto& [name, bytes] : WrittenNow()) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
  const std::vector<std::string> foreign = ForeignSkeletonTexts();
  std::ofstream(folder / "ost.yaml")
      << "camera_matrix:\n  data: [575.5, 0, 319.5, 0, 575.5, 239.5, 0, 0, 1]\n";
  const auto read_all = [&] {
    std::string all;
    for (const char* name : {"x.jsonl", "x.csv", "x.trc", "x.bvh"}) {
      WriteSkeletons(folder / "again.jsonl", ReadSkeletons(folder / name));
      all += FilesIn(folder.path()).at("again.jsonl");
    }
    for (const std::string& text : foreign) {
      std::istringstream stream(text);
      WriteSkeletons(folder / "again.jsonl", ReadSkeletonStream(stream, "x", {}));
      all += FilesIn(folder.path()).at("again.jsonl");
    }
    for (const char* name : {"camera.json", "ost.yaml"}) {
      const auto camera = depth::CameraForSize(depth::ReadCameraFile(folder / name), 640, 480);
      all += std::to_string(std::llround(1000 * camera.fx)) + " ";
    }
    return all;
  };
  const std::string expected = read_all();
  const CommaLocale locale;
  if (!locale.is_there()) GTEST_SKIP() << "no German locale can be made here";
  EXPECT_EQ(read_all(), expected);
}

}  // namespace
}  // namespace ossa::recon
