// Depth images of another program: through a pipe, on standard input, several in a file.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <thread>

#include "depth/image/camera_io.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/support/depth_examples.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::ExpectRefused;
using test::FramesOf;
using test::Notes;
using test::TemporaryFolder;
using test::WriteBytes;

constexpr int kWidth = 64, kHeight = 48;

std::vector<uint16_t> StreamDepths(int i) {
  return test::ExampleFrame(i, kWidth, kHeight).depth_mm;
}

std::string Pgm(const std::vector<uint16_t>& depths, const std::string& comments = "",
                int width = kWidth, int height = kHeight) {
  std::string text =
      "P5\n" + comments + std::to_string(width) + " " + std::to_string(height) + "\n65535\n";
  for (const uint16_t depth : depths) {
    text += static_cast<char>(depth >> 8);
    text += static_cast<char>(depth & 255);
  }
  return text;
}

std::string TwoImages() { return Pgm(StreamDepths(0)) + Pgm(StreamDepths(1)); }

// A named pipe and the program that writes into it.
class PipeTest : public testing::Test {
 protected:
  PipeTest() { mkfifo(name().c_str(), 0600); }

  std::string name() const { return folder_ / "camera"; }
  void Send(const std::string& bytes) {
    if (writer_.joinable()) writer_.join();
    writer_ = std::jthread([this, bytes] { WriteBytes(name(), bytes); });
  }
  void ExpectRefusal(const std::string& bytes, const std::string& text) {
    Send(bytes);
    ExpectRefused([&] { FramesOf(*OpenSource(name())); }, text);
  }

 private:
  TemporaryFolder folder_;
  std::jthread writer_;
};

TEST_F(PipeTest, ImagesAreReadAsTheyCome) {
  Send(TwoImages() + "\n" + Pgm(StreamDepths(2)));
  const auto source = OpenSource(name());
  EXPECT_TRUE(source->is_live());
  EXPECT_EQ(source->camera().width, kWidth);
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 3u);
  for (const int i : {0, 1, 2}) {
    EXPECT_EQ(frames[static_cast<size_t>(i)].depth_mm, StreamDepths(i));
    EXPECT_EQ(frames[static_cast<size_t>(i)].index, i);
  }
  EXPECT_EQ(frames[0].time_s, 0.0);
  EXPECT_LE(frames[1].time_s, frames[2].time_s);
  EXPECT_TRUE(IsStream(name()) && IsRecording(name()) && IsStream("-"));
}

TEST_F(PipeTest, AReaderIsNotHeldUpByASilentWriter) {
  std::ofstream writer;
  std::jthread opening([&] {
    writer.open(name(), std::ios::binary);
    writer << TwoImages() << Pgm(StreamDepths(2)) << std::flush;
  });
  const auto source = OpenSource(name());
  opening.join();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(test::Next(*source).status, ReadStatus::kFrame);
  EXPECT_EQ(test::Next(*source).status, ReadStatus::kTimeout);
  writer << Pgm(StreamDepths(3)).substr(0, 500) << std::flush;
  EXPECT_EQ(test::Next(*source).status, ReadStatus::kTimeout);
  writer << Pgm(StreamDepths(3)).substr(500) << std::flush;
  EXPECT_EQ(source->Read(std::chrono::seconds(5)).frame.depth_mm, StreamDepths(3));
  writer.close();
  EXPECT_EQ(source->Read(std::chrono::seconds(5)).status, ReadStatus::kEnd);
}

TEST_F(PipeTest, WaitingForTheFirstImageCanBeEnded) {
  SourceOptions options;
  options.keep_waiting = [] { return false; };
  ExpectRefused([&] { OpenSource(name(), options); }, "interrupted before the first image");
}

TEST_F(PipeTest, CommentsStateTimesAndCamera) {
  const std::string camera = "# camera 70.5,71,30,20\n";
  Send(Pgm(StreamDepths(0), "# anything\n# time_s 1700000000.25\n" + camera) +
       Pgm(StreamDepths(1), "#time_s 1700000000.5\n") +
       Pgm(StreamDepths(2), "# time_s 1700000001\n# camera 80,80,31,23\n"));
  const auto frames = FramesOf(*OpenSource(name()));
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0].time_s, 0.0);
  EXPECT_EQ(frames[1].time_s, 0.25);
  EXPECT_EQ(frames[2].time_s, 0.75);
  EXPECT_EQ(frames[1].camera.fx, 70.5);
  EXPECT_EQ(frames[1].camera.cy, 20.0);
  EXPECT_EQ(frames[2].camera.fx, 80.0);
}

TEST_F(PipeTest, OptionsArePreferredToComments) {
  Send(Pgm(StreamDepths(0), "# camera 70,70,30,20\n# time_s 5\n") +
       Pgm(StreamDepths(1), "# camera 80,80,30,20\n# time_s 7\n"));
  SourceOptions options;
  options.camera = ParseCamera("90,90,32,24");
  options.fps = 10.0;
  options.depth_scale = 2000.0;
  const auto frames = FramesOf(*OpenSource(name(), options));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].camera.fx, 90.0);
  EXPECT_EQ(frames[1].time_s, 0.1);
  EXPECT_NEAR(frames[1].depth_mm[0], StreamDepths(1)[0] / 2.0, 0.5);
}

TEST_F(PipeTest, DepthsOfAnotherUnitAreRefused) {
  auto eighths = StreamDepths(0);
  for (uint16_t& depth : eighths) depth = static_cast<uint16_t>(depth << 3);
  ExpectRefusal(Pgm(eighths) + Pgm(eighths) + Pgm(eighths), "--depth-scale 8000");
}

TEST_F(PipeTest, WhatIsNoImageIsRefusedByItsNumber) {
  ExpectRefusal("", "camera: expected PGM images of 16 bits, found nothing");
  ExpectRefusal("hello", "camera: image 0: expected a binary PGM image, P5, found 'he'");
  ExpectRefusal("P5 64 48 25", "image 0: cut short");
  ExpectRefusal(TwoImages() + "P6", "image 2: expected a binary PGM image, P5, found 'P6'");
  ExpectRefusal(TwoImages() + "P5 64 48 255\n", "image 2: expected 16 bits a pixel");
  ExpectRefusal("P5 64 x", "image 0: expected the height of a PGM image, 1 to 8192");
  ExpectRefusal("P5 64 48 65535x", "image 0: expected a blank behind the brightest value");
  ExpectRefusal("P5 #" + std::string(5000, 'x'), "image 0: expected a PGM header of at most");
  ExpectRefusal(Pgm(StreamDepths(0)) + Pgm(StreamDepths(1), "", kHeight, kWidth),
                "image 1: expected 64x48 like the others, found 48x64");
  ExpectRefusal(Pgm(StreamDepths(0), "# time_s soon\n"),
                "image 0: # time_s: expected seconds, found");
  ExpectRefusal(Pgm(StreamDepths(0), "# time_s 1700000000250\n"),
                "image 0: # time_s: expected seconds");
  ExpectRefusal(Pgm(StreamDepths(0), "# camera 1,2\n"), "image 0: # camera: ");
  ExpectRefusal(Pgm(StreamDepths(0), "# time_s 1\n") + Pgm(StreamDepths(1)),
                "image 1: expected a comment '# time_s SECONDS' like the first image's");
}

TEST_F(PipeTest, AnImageThatIsCutShortEndsItWithAWarning) {
  Send(TwoImages() + Pgm(StreamDepths(2)).substr(0, 3000));
  Notes notes;
  EXPECT_EQ(FramesOf(*OpenSource(name(), notes.Options())).size(), 2u);
  EXPECT_TRUE(notes.Tell("image 2: cut short: the 2 images before it are complete"));
}

TEST(SeveralPgms, InAFileAreARecording) {
  const TemporaryFolder folder;
  WriteBytes(folder / "all.PGM", TwoImages());
  const auto source = OpenSource(folder / "all.PGM");
  EXPECT_FALSE(source->is_live());
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].depth_mm, StreamDepths(1));
  EXPECT_EQ(frames[1].time_s, 1.0 / 30.0);
}

TEST(SeveralPgms, HaveTheCameraBesideThem) {
  const TemporaryFolder folder;
  WriteBytes(folder / "all.pgm", TwoImages());
  WriteCameraJson(folder / "camera.json",
                  {.width = kWidth, .height = kHeight, .fx = 77, .fy = 77, .cx = 32, .cy = 24});
  EXPECT_EQ(OpenSource(folder / "all.pgm")->camera().fx, 77.0);
}

TEST(SeveralPgms, OneAloneIsAStill) {
  const TemporaryFolder folder;
  WriteBytes(folder / "one.pgm", Pgm(StreamDepths(0)) + "\n");
  const auto source = OpenSource(folder / "one.pgm");
  EXPECT_EQ(source->frame_count(), 1);
  EXPECT_EQ(FramesOf(*source).size(), 1u);
}

}  // namespace
}  // namespace ossa::depth
