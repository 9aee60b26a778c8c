// The TOML of `ossa experiment --parameters`.
#include <cstdint>
#include <fstream>

#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tools/experiments/experiment.h"

std::vector<std::string> ossa::fuzz::Seeds() {
  return {
      "# numbers\nframes = 30\nnoise_m = 1.5e-2\nname = \"a \\\"b\\\"\"\nlist = [1, 2.5]\n"
      "names = [\"x\", \"y\"]\n"};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::string path = ossa::fuzz::ScratchPath("x.toml");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  ossa::fuzz::ExpectValueOrOneLine([&] {
    auto parameters = ossa::tools::Parameters::FromToml(path);
    parameters.Numbers("list", {});
    parameters.Integer("frames", 1);
    parameters.Text("name", "");
    parameters.RequireAllUsed();
  });
  return 0;
}
