// Posture databases and learned models: any payload is a value or an InputError.
#include <cstdint>

#include "recon/database/posture_database.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/recon/synthetic_motion.h"

namespace {

using ossa::recon::PostureDatabase;

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  std::vector<recon::PostureClip> clips(1);
  clips[0].name = "two";
  clips[0].postures = {recon::test::Gesture(0.2, 0.2, 0.1), recon::test::Gesture(1.5, 1.5, 0.1)};
  const std::string path = ScratchPath("database");
  PostureDatabase::Build(clips, {}).Save(path);
  return {TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto database =
        PostureDatabase::FromBytes(std::as_bytes(std::span(data, size)), "x.ossadb");
    if (database.size() < 1) abort();
  });
  return 0;
}
