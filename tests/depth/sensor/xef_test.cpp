// Recordings of Kinect Studio, as KinectXEFTools describes their format.
#include <gtest/gtest.h>

#include <string>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/depth/sensor/xef_writer.h"
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
using test::XefWriter;

constexpr uint64_t kSecond = 10'000'000;  // ticks

std::vector<uint16_t> Depths(int i) { return test::ExampleFrame(i, 512, 424).depth_mm; }

// Three depth images among infrared ones and a record of unknown content; the third is late.
std::string Recording(bool is_archived) {
  XefWriter writer(is_archived);
  if (is_archived) writer.AddUnknown(0xC018);
  writer.AddStream(1, "Nui IR", XefWriter::kInfrared).AddStream(2, "Nui Depth", XefWriter::kDepth);
  writer.AddEvent(1, 5 * kSecond, 70, Depths(8)).AddEvent(2, 5 * kSecond, 70, Depths(0));
  writer.AddUnknown(0x7000).AddUnknown(0x6000);
  writer.AddEvent(2, 5 * kSecond + kSecond / 10, 71, Depths(1));
  writer.AddEvent(2, 6 * kSecond, 74, Depths(2));
  return writer.Finish();
}

TEST(KinectStudio, RecordingsHaveTheirDepthImagesAndTimes) {
  const TemporaryFolder folder;
  for (const bool is_archived : {false, true}) {
    WriteBytes(folder / "x.XEF", Recording(is_archived));
    Notes notes;
    const auto source = OpenSource(folder / "x.XEF", notes.Options());
    EXPECT_EQ(source->frame_count(), 3);
    EXPECT_EQ(source->camera().width, 512);
    EXPECT_NEAR(source->camera().fx, 366, 1);
    const auto frames = FramesOf(*source);
    ASSERT_EQ(frames.size(), 3u);
    for (const int i : {0, 1, 2}) EXPECT_EQ(frames[static_cast<size_t>(i)].depth_mm, Depths(i));
    EXPECT_NEAR(frames[1].time_s, 0.1, 1e-9);
    EXPECT_NEAR(frames[2].time_s, 1.0, 1e-9);
    EXPECT_EQ(frames[2].index, 4) << "72 and 73 are missing";
    EXPECT_TRUE(notes.Tell("--mirrored exchanges left and right"));
    EXPECT_FALSE(notes.Tell("damaged"));
  }
  EXPECT_TRUE(IsRecording(folder / "x.XEF"));
}

TEST(KinectStudio, RecordingsThatWereCutShortGiveTheImagesBefore) {
  const TemporaryFolder folder;
  const std::string sound = Recording(false);
  WriteBytes(folder / "x.xef", sound.substr(0, sound.size() - 0x6b0 - 100));
  Notes notes;
  EXPECT_EQ(FramesOf(*OpenSource(folder / "x.xef", notes.Options())).size(), 2u);
  EXPECT_TRUE(notes.Tell("cut short: 2 depth images are complete"));
}

TEST(KinectStudio, DamagedEventsAreLeftOutWithAWarning) {
  const TemporaryFolder folder;
  std::string bytes = Recording(false);
  constexpr size_t kEvent = 434204, kBetween = 0x7000 + 0x6000, kFooter = 0x6b2;
  const size_t first = bytes.size() - 3 * kEvent - kBetween - kFooter;
  bytes[first + 7] = '\x7f';  // the length of the first depth image
  WriteBytes(folder / "x.xef", bytes);
  Notes notes;
  EXPECT_EQ(FramesOf(*OpenSource(folder / "x.xef", notes.Options())).size(), 2u);
  EXPECT_TRUE(notes.Tell("damaged: " + std::to_string(kEvent + kBetween) + " bytes are no event"))
      << notes.text;
}

TEST(KinectStudio, DamagedCompressedImagesAreAnError) {
  const TemporaryFolder folder;
  std::string bytes = Recording(true);
  bytes[bytes.size() - 0x6b0 - 200] = static_cast<char>(bytes[bytes.size() - 0x6b0 - 200] ^ 8);
  WriteBytes(folder / "x.xef", bytes);
  ExpectRefused([&] { FramesOf(*OpenSource(folder / "x.xef")); }, "compressed bytes are damaged");
}

TEST(KinectStudio, RecordingsWithoutDepthAreRefused) {
  const TemporaryFolder folder;
  XefWriter writer;
  writer.AddStream(1, "Nui IR", XefWriter::kInfrared).AddEvent(1, 0, 0, Depths(0));
  WriteBytes(folder / "x.xef", writer.Finish());
  ExpectRefused([&] { OpenSource(folder / "x.xef"); }, "none in its streams: Nui IR");
  WriteBytes(folder / "x.xef", "EVENTS");
  ExpectRefused([&] { OpenSource(folder / "x.xef"); }, "expected a recording of Kinect Studio");
}

}  // namespace
}  // namespace ossa::depth
