// Recordings of Stray Scanner: the colour camera's intrinsics, times, confidences.
#include <gtest/gtest.h>

#include <fstream>

#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::Next;
using test::Notes;
using test::TemporaryFolder;
using test::WriteFrame;

class StrayScanner : public testing::Test {
 protected:
  StrayScanner() {
    for (const char* name : {"depth", "confidence"}) {
      std::filesystem::create_directory(folder_ / name);
    }
    for (const char* name : {"000000.png", "000001.png", "000003.png"}) {
      WriteFrame(folder_ / "depth" / name, 700, 256, 192);
      Image<uint8_t> confidence(256, 192);
      for (size_t i = 0; i < confidence.data.size(); ++i) {
        confidence.data[i] = static_cast<uint8_t>(i % 3);
      }
      WriteLabelPng(folder_ / "confidence" / name, confidence);
    }
    WriteCamera("1333.9, 0.0, 962.25\n0.0, 1333.9, 722.25\n0.0, 0.0, 1.0");
    std::ofstream(folder_ / "odometry.csv") << "timestamp, frame, x, y, z, qx, qy, qz, qw\n"
                                               "260186.9, 000000, 0.1, 0, 0, 1, 0, 0, 0\n"
                                               "260187.0, 000001, 0.1, 0, 0, 1, 0, 0, 0\n"
                                               "260187.1, 000002, 0.1, 0, 0, 1, 0, 0, 0\n"
                                               "260187.4, 000003, 0.1, 0, 0, 1, 0, 0, 0\n";
  }

  void WriteCamera(const char* text) { std::ofstream(folder_ / "camera_matrix.csv") << text; }

  const TemporaryFolder folder_;
};

TEST_F(StrayScanner, IsReadWithItsCameraTimesAndConfidences) {
  EXPECT_TRUE(IsRecording(folder_.path()));
  for (const auto& path : {folder_.path(), folder_ / "depth"}) {
    Notes notes;
    const auto source = OpenSource(path.string(), notes.Options());
    const Camera& camera = source->camera();
    EXPECT_NEAR(camera.fx, 1333.9 * 256 / 1920, 1e-9);
    EXPECT_NEAR(camera.fy, 1333.9 * 192 / 1440, 1e-9);
    EXPECT_NEAR(camera.cx, 962.25 * 256 / 1920, 0.5);  // by either convention of pixel centres
    EXPECT_NEAR(camera.cy, 722.25 * 192 / 1440, 0.5);
    EXPECT_TRUE(notes.Tell("confidence")) << notes.text;
    const ReadResult first = Next(*source);
    EXPECT_EQ(first.frame.depth_mm[0], 0);
    EXPECT_EQ(first.frame.depth_mm[1], 700);
    EXPECT_EQ(first.frame.depth_mm[2], 700);
    EXPECT_NEAR(Next(*source).frame.time_s, 0.1, 1e-6);
    EXPECT_NEAR(Next(*source).frame.time_s, 0.5, 1e-6);
    EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
  }
}

TEST_F(StrayScanner, CameraOfOtherImagesIsIgnoredWithANote) {
  WriteCamera("575, 0, 320\n0, 575, 240\n0, 0, 1");
  Notes notes;
  OpenSource((folder_ / "depth").string(), notes.Options());
  EXPECT_TRUE(notes.Tell("camera_matrix.csv: ignored")) << notes.text;
  EXPECT_TRUE(notes.Tell("its centre is not that of images of 1920x1440")) << notes.text;
}

TEST_F(StrayScanner, FrameWithABrokenConfidenceIsSkippedWithAWarning) {
  WriteLabelPng(folder_ / "confidence/000001.png", Image<uint8_t>(128, 96));
  Notes notes;
  const auto source = OpenSource(folder_.path().string(), notes.Options());
  int frames = 0;
  while (Next(*source).status == ReadStatus::kFrame) ++frames;
  EXPECT_EQ(frames, 2);
  EXPECT_TRUE(notes.Tell("expected 256x192 like the depth image, found 128x96")) << notes.text;
}

// Of a time-of-flight camera, from 0 to 255.
TEST_F(StrayScanner, OtherConfidencesAreNotUsed) {
  Image<uint8_t> other(256, 192);
  other.data[1] = 255;
  for (const char* name : {"000000.png", "000001.png", "000003.png"}) {
    WriteLabelPng(folder_ / "confidence" / name, other);
  }
  EXPECT_EQ(Next(*OpenSource(folder_.path().string())).frame.depth_mm[0], 700);
}

// As of an app that was killed.
TEST_F(StrayScanner, FramesWithoutATimeAreLeftOutWithAWarningUnlessTheRateIsGiven) {
  std::ofstream(folder_ / "odometry.csv") << "timestamp, frame, x\n1.5, 000000, 0\n1.6, 0000";
  const auto count = [&](SourceOptions options) {
    const auto source = OpenSource(folder_.path().string(), options);
    int frames = 0;
    while (Next(*source).status == ReadStatus::kFrame) ++frames;
    return frames;
  };
  Notes notes;
  SourceOptions options = notes.Options();
  EXPECT_EQ(count(options), 1);
  EXPECT_TRUE(notes.Tell("expected the times of 3 depth images, found 1")) << notes.text;
  options.fps = 60.0;
  EXPECT_EQ(count(options), 3);
}

TEST_F(StrayScanner, TableWithoutTimesGivesAWarningAndAnotherTableNone) {
  for (const char* table : {"timestamp, frame, x\n", "time,x,y\n1,0,0\n"}) {
    std::ofstream(folder_ / "odometry.csv") << table;
    Notes notes;
    const auto source = OpenSource(folder_.path().string(), notes.Options());
    Next(*source);
    EXPECT_NEAR(Next(*source).frame.time_s, 1.0 / 30.0, 1e-6);
    EXPECT_EQ(notes.Tell("depth images, found 0: 30 frames a second"), table[4] == 's') << table;
  }
}

}  // namespace
}  // namespace ossa::depth
