// Recordings that a program of their own reads by somebody's library: .mkv and .bag, chosen by the
// first byte. Whatever that comes to, who asked gets images or an InputError of one line.
#include <cstdint>
#include <fstream>

#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/robustness/recordings.h"

std::vector<std::string> ossa::fuzz::Seeds() {
  std::vector<std::string> seeds;
  for (const test::DamageSample& sample : test::PlainRecordings()) {
    seeds.push_back((sample.name.ends_with(".mkv") ? "m" : "b") + sample.bytes);
  }
  return seeds;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  static const std::string mkv = ossa::fuzz::ScratchPath("x.mkv");
  static const std::string bag = ossa::fuzz::ScratchPath("x.bag");
  const std::string& path = data[0] == 'm' ? mkv : bag;
  std::ofstream(path, std::ios::binary)
      << std::string(reinterpret_cast<const char*>(data) + 1, size - 1);
  ossa::fuzz::ExpectValueOrOneLine([&] { ossa::test::ReadRecording(path); });
  return 0;
}
