// The frame around our binary files, and taking values out of a payload.
#include <cstdint>
#include <filesystem>

#include "depth/base/checksummed_container.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

constexpr ossa::ContainerFormat kFormat{{'O', 'S', 'S', 'A', 'F', 'U', 'Z', 'Z'}, 3, "example"};

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  PayloadWriter writer;
  writer.PutString("text");
  writer.PutVector(std::vector<float>{1, 2, 3});
  writer.Put<uint32_t>(7);
  const std::string path = ScratchPath("seed");
  WriteContainer(path, kFormat, writer.bytes());
  const auto& bytes = writer.bytes();
  return {TakeFile(path), std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  ossa::fuzz::ExpectValueOrOneLine([&] { ossa::ReadContainerBytes(bytes, "x.ossa", kFormat); });
  ossa::fuzz::ExpectValueOrOneLine([&] {
    ossa::PayloadReader reader(bytes, "x.ossa");
    reader.GetString("name");
    reader.GetVector<float>("numbers");
    reader.Get<uint32_t>("count");
    reader.ExpectEnd();
  });
  return 0;
}
