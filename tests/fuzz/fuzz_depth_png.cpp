// Depth and label images: any bytes are an image or an InputError of one line.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "depth/base/error.h"
#include "depth/image/png_codec_internal.h"
#include "tests/fuzz/seeds.h"

std::vector<std::string> ossa::fuzz::Seeds() {
  std::vector<std::string> seeds;
  for (const int bits : {8, 16}) {
    const size_t stride = 5 * static_cast<size_t>(bits / 8);
    std::vector<uint8_t> samples(stride * 3);
    for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint8_t>(37 * i);
    const auto png = depth::EncodeGreyPng(samples.data(), {5, 3}, stride, bits);
    seeds.emplace_back(png.begin(), png.end());
  }
  return seeds;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // A random file is hardly ever a PNG of the right kind: also try what follows a good header.
  static const std::vector<uint8_t> whole = [] {
    const std::vector<uint8_t> samples(2 * 8 * 6, 7);
    return ossa::depth::EncodeGreyPng(samples.data(), {8, 6}, 16, 16);
  }();
  constexpr size_t kHeaderAndItsChecksum = 33;
  std::vector<uint8_t> with_header(whole.begin(), whole.begin() + kHeaderAndItsChecksum);
  with_header.insert(with_header.end(), data, data + size);
  for (const std::span<const uint8_t> bytes :
       {std::span(data, size), std::span<const uint8_t>(with_header)}) {
    for (const int depth : {8, 16}) {
      try {
        std::vector<uint8_t> samples;
        const auto image = ossa::depth::DecodeGreyPng(bytes, depth, "x.png", &samples);
        const auto pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
        if (samples.size() != pixels * static_cast<size_t>(depth / 8)) abort();
      } catch (const ossa::InputError& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) abort();
      }
    }
  }
  return 0;
}
