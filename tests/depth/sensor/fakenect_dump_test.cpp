#include "depth/sensor/fakenect_dump.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/support/depth_examples.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

// The first depth image of a dump; its last bytes are the pixels.
std::string PictureIn(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".pgm") continue;
    std::ifstream file(entry.path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  return "";
}

TEST(FakenectDump, BorrowedImagesGiveTheSameDumpAsCopies) {
  const test::TemporaryFolder folder;
  const DepthFrame copy = test::ExampleFrame(0, 640, 480);
  DepthFrame borrowed;
  borrowed.camera = copy.camera;
  borrowed.borrowed = copy.view();
  FakenectDump(folder / "a", copy.camera).Write(copy);
  FakenectDump(folder / "b", copy.camera).Write(borrowed);
  EXPECT_FALSE(PictureIn(folder / "a").empty());
  EXPECT_EQ(PictureIn(folder / "a"), PictureIn(folder / "b"));
}

TEST(FakenectDump, IsReadAsAFolder) {
  const test::TemporaryFolder folder;
  FakenectDump dump(folder / "a", test::ExampleFrame(0, 640, 480).camera);
  for (const int i : {0, 1}) dump.Write(test::ExampleFrame(i, 640, 480));
  dump.Finish();
  const auto frames = test::FramesOf(*OpenSource(folder / "a"));
  ASSERT_EQ(frames.size(), 2u);
  for (const int i : {0, 1}) {
    EXPECT_EQ(frames[static_cast<size_t>(i)].depth_mm, test::ExampleFrame(i, 640, 480).depth_mm);
    EXPECT_NEAR(frames[static_cast<size_t>(i)].time_s, i / 30.0, 1e-5);
  }
}

TEST(FakenectDump, RefusesAnImageOfFewerPixelsThanItsCamera) {
  const test::TemporaryFolder folder;
  DepthFrame frame = test::ExampleFrame(0, 640, 480);
  frame.depth_mm.resize(100);
  test::ExpectRefused([&] { FakenectDump(folder / "a", frame.camera).Write(frame); }, "found 100");
}

}  // namespace
}  // namespace ossa::depth
