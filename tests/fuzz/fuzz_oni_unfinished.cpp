// Recordings of ours without their end: whatever follows the head, every frame is of the camera's
// size, and nothing is read beyond the file.
#include <cstdint>
#include <fstream>
#include <span>

#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_recorder.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

using namespace ossa::depth;

std::string Recording() {
  const std::string path = ossa::fuzz::ScratchPath("seed.oni");
  DepthFrame frame{{800, 800, 0, 900, 801, 802, 3000, 800, 800, 800, 800, 7}, KinectV1Camera(4, 3)};
  OniRecorder recorder(path, frame.camera);
  recorder.Write(frame);
  recorder.Finish();
  return ossa::fuzz::TakeFile(path);
}

// Before the first frame; its property that would vouch for the rest says nothing.
std::string Head() {
  std::string bytes = Recording();
  const std::string frame("NIR\0\x0A\0\0\0", 8);
  bytes.resize(bytes.find(frame));
  constexpr size_t kNameAndSize = sizeof("ossaSeal") + 4;  // with its final zero
  bytes.replace(bytes.find("ossaSeal") + kNameAndSize, 8, 8, '\0');
  return bytes;
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() { return {Recording().substr(Head().size())}; }

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::string head = Head();
  static const std::string path = ossa::fuzz::ScratchPath("x.oni");
  std::ofstream(path, std::ios::binary)
      << head << std::string_view(reinterpret_cast<const char*>(data), size);
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto source = OpenSource(path);
    for (;;) {
      const ReadResult result = source->Read(std::chrono::milliseconds(0));
      if (result.status != ReadStatus::kFrame) break;
      if (result.frame.depth_mm.size() != 12) abort();
    }
  });
  return 0;
}
