// Images that stay where they lie: a driver's buffer, a part of a larger image.
#include <fstream>
#include <iterator>

#include "depth/image/turn.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/picture.h"

namespace ossa::tracker {
namespace {

constexpr uint16_t kElsewhere_mm = 700;  // beside the image; a tracker that reads it finds a wall

// The frame's image with something else on either side of each row.
struct Buffer {
  explicit Buffer(const depth::DepthFrame& frame)
      : stride(frame.camera.width + 30),
        pixels(static_cast<size_t>(stride * frame.camera.height), kElsewhere_mm) {
    for (int v = 0; v < frame.camera.height; ++v) {
      std::copy_n(&frame.depth_mm[static_cast<size_t>(v * frame.camera.width)], frame.camera.width,
                  &pixels[static_cast<size_t>(v * stride + 10)]);
    }
  }
  depth::DepthFrame Borrow(const depth::DepthFrame& from) const {
    depth::DepthFrame frame;
    frame.camera = from.camera;
    frame.borrowed = {&pixels[10], from.camera.width, from.camera.height, stride};
    return frame;
  }

  int stride;
  std::vector<uint16_t> pixels;
};

void ExpectSame(const BodyFrame& a, const BodyFrame& b) {
  EXPECT_EQ(a.users.data, b.users.data);
  ASSERT_EQ(a.bodies.size(), 1U);
  ASSERT_EQ(b.bodies.size(), 1U);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    EXPECT_EQ(a.bodies[0].joints[j].position_m, b.bodies[0].joints[j].position_m) << j;
  }
}

TEST(BorrowedImage, GivesTheSameResultsAsACopyInEveryStage) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.0, 2.5)});
  const Buffer buffer(render.frame);
  Tracker copied{TrackerOptions{}}, borrowed{TrackerOptions{}};
  ExpectSame(borrowed.Track(buffer.Borrow(render.frame)), copied.Track(render.frame));
}

TEST(BorrowedImage, IsDrawn) {
  const test::TemporaryFolder folder;
  const auto render = Rendered({PersonAt(0.0, 2.5)});
  const Buffer buffer(render.frame);
  BodyFrame nobody;
  nobody.users = {render.frame.camera.width, render.frame.camera.height, 0};
  WritePicture(folder / "copied.png", render.frame, nobody);
  WritePicture(folder / "borrowed.png", buffer.Borrow(render.frame), nobody);
  const auto bytes_of = [&](const char* name) {
    std::ifstream file(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(bytes_of("borrowed.png"), bytes_of("copied.png"));
}

TEST(BorrowedImage, IsRotated) {
  OSSA_NEEDS_MODEL();
  const depth::DepthFrame lying = depth::Turned(Rendered({PersonAt(0.0, 2.5)}).frame, 1);
  const Buffer buffer(lying);
  TrackerOptions options = PlainOptions();
  options.turn = Turn::kThreeQuarters;
  Tracker copied(options), borrowed(options);
  ExpectSame(borrowed.Track(buffer.Borrow(lying)), copied.Track(lying));
}

TEST(BorrowedImage, SizeMustMatchTheCamera) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.0, 2.5)});
  const Buffer buffer(render.frame);
  depth::DepthFrame frame = buffer.Borrow(render.frame);
  frame.borrowed.width /= 2;
  frame.borrowed.height *= 2;
  EXPECT_THROW(Tracker(PlainOptions()).Track(frame), InputError);
}

}  // namespace
}  // namespace ossa::tracker
