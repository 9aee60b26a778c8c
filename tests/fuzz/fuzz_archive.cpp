// Archives of skeleton recordings: .gz, .tar, .tar.gz, .zip.
#include <zlib.h>

#include <cstdint>
#include <fstream>

#include "recon/files/skeleton_io.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/recon/files/tar_bytes.h"
#include "tests/recon/files/zip_bytes.h"

namespace {

const std::string kFrame = "{\"frame\":0,\"time_s\":0,\"bodies\":[]}\n";

std::string Gzip(const std::string& content) {
  const std::string path = ossa::fuzz::ScratchPath("seed.gz");
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
  return ossa::fuzz::TakeFile(path);
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  const std::string path = ScratchPath("seed.tar");
  recon::WriteTar(path, {{"a.jsonl", kFrame}, {"b/c.jsonl", kFrame}});
  const std::string tar = TakeFile(path);
  return {tar, Gzip(tar), Gzip(kFrame), recon::Zip({{"a.jsonl", kFrame}, {"b.jsonl", kFrame}})};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::string path = ossa::fuzz::ScratchPath("x");
  std::ofstream(path, std::ios::binary)
      << std::string_view(reinterpret_cast<const char*>(data), size);
  ossa::fuzz::ExpectValueOrOneLine([&] { ossa::recon::ReadSkeletonClips(path); });
  return 0;
}
