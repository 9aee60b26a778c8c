// Depth files of Microsoft Research's action data sets.
#include <gtest/gtest.h>

#include <string>

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
using test::TemporaryFolder;
using test::WriteBytes;

std::string MsrBytes(int frames, bool has_users) {
  std::string bytes;
  const auto put = [&bytes](uint32_t number) {
    for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(number >> (8 * byte) & 255);
  };
  for (const int count : {frames, 32, 24}) put(static_cast<uint32_t>(count));
  for (int frame = 0; frame < frames; ++frame) {
    const auto depths = test::ExampleFrame(frame).depth_mm;
    for (size_t row = 0; row < 24; ++row) {
      for (size_t u = 0; u < 32; ++u) put(depths[row * 32 + u]);
      if (has_users) bytes += std::string(32, '\1');
    }
  }
  return bytes;
}

TEST(MsrDepth, IsReadWithUsersAndWithout) {
  const TemporaryFolder folder;
  for (const bool has_users : {false, true}) {
    WriteBytes(folder / "a01_s01_e01_depth.bin", MsrBytes(3, has_users));
    EXPECT_TRUE(IsRecording(folder / "a01_s01_e01_depth.bin"));
    const auto source = OpenSource(folder / "a01_s01_e01_depth.bin");
    EXPECT_EQ(source->frame_count(), 3);
    const auto frames = FramesOf(*source);
    ASSERT_EQ(frames.size(), 3u);
    for (const int i : {0, 1, 2}) {
      EXPECT_EQ(frames[static_cast<size_t>(i)].depth_mm, test::ExampleFrame(i).depth_mm);
    }
    EXPECT_EQ(frames[2].time_s, 2.0 / 30.0);
  }
}

TEST(MsrDepth, OfAnotherSizeThanItsCountsIsOtherNumbers) {
  const TemporaryFolder folder;
  WriteBytes(folder / "x.bin", MsrBytes(3, true) + "x");
  ExpectRefused([&] { OpenSource(folder / "x.bin"); }, "numbers without a header");
  WriteBytes(folder / "x.bin", "x");
  ExpectRefused([&] { OpenSource(folder / "x.bin"); }, "numbers without a header");
}

}  // namespace
}  // namespace ossa::depth
