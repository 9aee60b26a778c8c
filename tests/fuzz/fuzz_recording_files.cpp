// Recordings that a program of their own reads by somebody's library, and images, of the kind that
// the first byte chooses. Whatever that comes to, who asked gets images or an InputError of one
// line.
#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/robustness/recordings.h"

namespace {

constexpr std::array<const char*, 11> kKinds = {"x.bag", "x.mkv", "x.db3", "x.mcap",
                                                "x.npy", "x.npz", "x.mat", "x.h5",
                                                "x.tif", "x.pgm", "x.xef"};

// The byte that stands for a file's kind.
char KindOf(const std::string& name) {
  const std::string extension = name.substr(name.rfind('.'));
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&extension](std::string_view each) {
    return each.ends_with(extension);
  });
  return static_cast<char>(kind - kKinds.begin());
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  std::vector<std::string> seeds;
  for (const test::DamageSample& sample : test::PlainRecordings()) {
    seeds.push_back(KindOf(sample.name) + sample.bytes);
    if (sample.name.ends_with(".pgm")) seeds.push_back(seeds.back() + sample.bytes);  // a recording
  }
  return seeds;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string path = ossa::fuzz::ScratchPath(kKinds[data[0] % kKinds.size()]);
  std::ofstream(path, std::ios::binary)
      << std::string(reinterpret_cast<const char*>(data) + 1, size - 1);
  ossa::fuzz::ExpectValueOrOneLine([&] { ossa::test::ReadRecording(path); });
  return 0;
}
