// Skeleton recordings in every format that is read, found by content or named by the first byte.
#include <cstdint>
#include <filesystem>
#include <sstream>

#include "recon/files/skeleton_io.h"
#include "tests/depth/sensor/xef_writer.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/recon/files/xef_bodies.h"
#include "tests/recon/motion/figure.h"

namespace {

using namespace ossa::recon;

// One recording in our own formats, and in those whose texts the readers' tests make.
SkeletonSequence TwoFrames() {
  SkeletonSequence sequence;
  for (int f = 0; f < 2; ++f) {
    BodyRecord body;
    body.id = 1;
    for (size_t j = 0; j < kJointCount; ++j) {
      body.joints[j] = JointRecord{};
      body.joints[j]->position_m = {0.01 * static_cast<double>(j), 0.1 * f, 2.0};
    }
    SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    frame.bodies = {body};
    sequence.frames.push_back(frame);
  }
  return sequence;
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  std::vector<std::string> seeds;
  for (const char* extension : {"x.jsonl", "x.csv", "x.trc", "x.bvh"}) {
    const std::string path = ScratchPath(extension);
    WriteSkeletons(path, TwoFrames());
    seeds.push_back('\0' + TakeFile(path));
  }
  for (const bool is_archived : {false, true}) {
    test::XefWriter writer(is_archived);
    writer.AddStream(1, "Nui Body Frame", test::XefWriter::kBodies);
    writer.AddEvent(1, 0, 0, test::XefBodies().Set(0, 1, 0.5F).bytes());
    seeds.push_back('\0' + writer.Finish());
  }
  for (const std::string& text : ForeignSkeletonTexts()) seeds.push_back('\0' + text);
  seeds.push_back('\0' + recon::test::FigureBvh({.frames = 2}));
  seeds.push_back(
      '\0' + recon::test::FigureBvh({.units_per_cm = 0.01, .frames = 2, .bones_along_x = true}));
  return seeds;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  static const std::vector<std::string> formats = SkeletonFormats();
  SkeletonReadOptions options;
  if (data[0] % 2 == 1) options.format = formats[data[0] / 2u % formats.size()];
  if (data[0] >= 128) options.columns = data[0] % 4 < 2 ? "truth" : "observed";
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  ossa::fuzz::ExpectValueOrOneLine([&] {
    for (const SkeletonFrame& frame : ReadSkeletonStream(stream, "x", options).frames) {
      for (const BodyRecord& body : frame.bodies) {
        for (const auto& joint : body.joints) {
          if (joint && !joint->position_m.allFinite()) abort();
        }
      }
    }
  });
  return 0;
}
