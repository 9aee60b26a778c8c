// The part of an .oni that ossa itself reads: never past its end, whatever it says.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/oni_recorder.h"
#include "tests/fuzz/seeds.h"

std::vector<std::string> ossa::fuzz::Seeds() {
  const std::string path = ScratchPath("seed.oni");
  depth::DepthFrame frame{std::vector<uint16_t>(12, 800), depth::KinectV1Camera(4, 3)};
  depth::OniRecorder recorder(path, frame.camera);
  recorder.Write(frame);
  recorder.Finish();
  return {TakeFile(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto preamble = ossa::depth::ParseOniPreamble({data, size});
  if (preamble.size > size || (preamble.seal && preamble.seal_at + 8 > preamble.size)) abort();
  if (preamble.camera && !(preamble.camera->fx > 0)) abort();
  return 0;
}
