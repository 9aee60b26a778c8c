// Recordings of other programs, read by the readers' libraries.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using std::chrono::milliseconds;
using test::FramesOf;

bool HasReader(const char* program) {
  return std::filesystem::exists(test::BinaryFolder() / "lib/openni2/reader" / program);
}

TEST(AzureKinectMkv, IsReadWithItsCalibrationAndUndistorted) {
  const auto path = test::SharedFolder() / "real/recordings/azure_kinect.mkv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not here: " << path;
  if (!HasReader("ossa_mkv_reader")) GTEST_SKIP() << "built without libavformat";
  const auto source = OpenSource(path.string());
  const Camera& camera = source->camera();
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 576);
  EXPECT_NEAR(camera.fx, 504.6, 0.1);  // 0.49278 of 1024
  EXPECT_NEAR(camera.fy, 504.7, 0.1);
  EXPECT_NEAR(camera.cx, 332.8, 0.1);
  EXPECT_NEAR(camera.cy, 348.8, 0.1);
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].time_s, 0.463945, 1e-6);
  std::vector<uint16_t> depths = frames[0].depth_mm;
  std::erase(depths, uint16_t{0});
  ASSERT_GT(depths.size(), 100'000u);
  std::nth_element(depths.begin(), depths.begin() + static_cast<ptrdiff_t>(depths.size() / 2),
                   depths.end());
  EXPECT_GT(depths[depths.size() / 2], 200);
  EXPECT_LT(depths[depths.size() / 2], 4000);
}

TEST(AzureKinectMkv, DamageIsRefusedInOneLine) {
  if (!HasReader("ossa_mkv_reader")) GTEST_SKIP() << "built without libavformat";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "x.mkv") << "not Matroska";
  test::ExpectRefused([&] { OpenSource(folder / "x.mkv"); }, "expected a Matroska recording");
}

TEST(RosBag, DamageIsRefusedInOneLine) {
  if (!HasReader("ossa_bag_reader")) GTEST_SKIP() << "built without rosbag_storage";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "x.bag") << "#ROSBAG V2.0\nthen nothing";
  test::ExpectRefused([&] { OpenSource(folder / "x.bag"); }, "expected a");
}

TEST(OpenNi1Oni, IsRead) {
  const auto path = test::SharedFolder() / "real/recordings/kinect_v1_openni1.oni";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not here: " << path;
  const auto source = OpenSource(path.string());
  EXPECT_EQ(source->camera().width, 640);
  EXPECT_NEAR(source->camera().fx, 575.8, 0.1);  // its field of view, 58.1 degrees
  EXPECT_EQ(FramesOf(*source).size(), 12u);
}

TEST(OtherRecordings, AreRefusedWithAWayToConvertThem) {
  const test::TemporaryFolder folder;
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"a.MP4", "ffmpeg"},          {"a.zstd", "zstd -d"},       {"a.pkl", "ossa.Tracker"},
      {"a.exr", "of floats"},       {"a.bin", "numpy.fromfile"}, {"a.PLY", "a cloud of points"},
      {"a.svo2", "ZED_SVO_Export"}, {"a.sens", "reader.py"},     {"a.klg", "ElasticFusion"},
      {"a.pfm", "floats"},          {"a.jp2", "ImageMagick"}};
  for (const auto& each : cases) {
    const auto path = folder / each.first;
    std::ofstream(path) << "x";
    EXPECT_TRUE(IsRecording(path));
    test::ExpectRefused([&] { OpenSource(path); }, each.second);
  }
}

TEST(OtherImages, AreRefusedWithAWayToConvertThem) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "depth_0.jp2") << "x";
  test::ExpectRefused([&] { OpenSource(folder.path()); },
                      "depth_0.jp2: expected depth images, such as 16-bit PNGs, found an image");
  EXPECT_TRUE(IsRecording(folder.path())) << "and not skeletons to ossa info";
  std::ofstream(folder / "walk.bvh") << "HIERARCHY";
  EXPECT_FALSE(IsRecording(folder.path()));
}

}  // namespace
}  // namespace ossa::depth
