// Sources by name: stills, recordings, and what is no source.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <string>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::Next;
using test::TemporaryFolder;
using test::WriteFrame;

TEST(OpenSource, ReadsASinglePng) {
  const TemporaryFolder folder;
  WriteFrame(folder / "000007.png", 70);
  WriteFrame(folder / "000008.PNG", 80);
  for (const char* name : {"000007.png", "000008.PNG"}) {
    EXPECT_TRUE(IsRecording(folder / name));
    const auto source = OpenSource((folder / name).string());
    EXPECT_EQ(source->frame_count(), 1);
    const ReadResult only = Next(*source);
    ASSERT_EQ(only.status, ReadStatus::kFrame);
    EXPECT_EQ(only.frame.depth_mm[0], name[5] == '7' ? 70 : 80);
    EXPECT_EQ(only.frame.index, 0);
    EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
  }
  Camera camera = KinectV1Camera(8, 6);
  camera.fx = 5.0;
  WriteCameraJson(folder / "camera.json", camera);
  EXPECT_EQ(OpenSource((folder / "000007.png").string())->camera().fx, 5.0);
  std::ofstream(folder / "cut.png") << "\x89PNG";
  EXPECT_THROW(OpenSource((folder / "cut.png").string()), InputError);
  EXPECT_THROW(OpenSource((folder / "none.png").string()), InputError);
}

TEST(SourceOptions, InvalidNumbersAreRefused) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1);
  const std::string name = folder.path().string();
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    test::ExpectRefused([&] { OpenSource(name, {.depth_scale = bad}); }, "depth_scale");
    test::ExpectRefused([&] { OpenSource(name, {.fps = bad}); }, "fps");
  }
  test::ExpectRefused(
      [&] { OpenSource(name, {.depth_scale = 1000.0, .depth_format = DepthFormat::kDisparity}); },
      "depth_scale: expected none with raw shifts");
  test::ExpectRefused([&] { OpenSource(name, {.inverted_from = 0}); }, "inverted_from");
}

TEST(OpenSource, ReportsWhatANonRegularFileIs) {
  const TemporaryFolder folder;
  for (const char* name : {"pipe.oni", "pipe.mkv", "pipe.bag"}) {
    mkfifo((folder / name).c_str(), 0600);
    test::ExpectRefused([&] { OpenSource((folder / name).string()); }, "found a pipe or a device");
  }
  test::ExpectRefused([&] { OpenSource((folder / "none.oni").string()); },
                      "none.oni: expected an .oni recording, found no file");
}

TEST(OpenSource, ReportsFilesOfAnotherKindAsSuch) {
  const TemporaryFolder folder;
  std::ofstream(folder / "depth.xyz") << "II*";
  test::ExpectRefused([&] { OpenSource((folder / "depth.xyz").string()); },
                      "found a file of another name");
  test::ExpectRefused([&] { OpenSource((folder / "none.xyz").string()); },
                      "found no such file or folder");
}

TEST(OpenSource, RefusesOtherInputInOneLine) {
  const TemporaryFolder folder;
  for (const std::string& name : {std::string("/nowhere"), folder.path().string(), std::string()}) {
    try {
      OpenSource(name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << error.what();
    }
  }
}

TEST(RealFrames, SkeltrackHasEightFramesOf640x480) {
  const std::string folder = test::SharedFolder() / "real/depth_frames/skeltrack_v1";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "not here: " << folder;
  const auto source = OpenSource(folder);
  int count = 0;
  for (ReadResult result; (result = Next(*source)).status == ReadStatus::kFrame; ++count) {
    EXPECT_EQ(result.frame.depth_mm.size(), 640u * 480u);
    EXPECT_EQ(result.dropped, 0);
  }
  EXPECT_EQ(count, 8);
}

}  // namespace
}  // namespace ossa::depth
