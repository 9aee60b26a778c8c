// Checksums are verified: no damage to a .gz, .tar.gz or .zip passes silently.
#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <map>
#include <random>

#include "recon/files/skeleton_io.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/tar_bytes.h"
#include "tests/recon/files/zip_bytes.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::ExpectRefused;
using test::TemporaryFolder;

std::string BytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void Put(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string Jsonl(int frames) {
  std::string text;
  for (int f = 0; f < frames; ++f) {
    text += fmt::format(R"({{"frame":{0},"time_s":{0},"bodies":[]}})"
                        "\n",
                        f);
  }
  return text;
}

std::string Gzip(const std::string& content) {
  const TemporaryFolder folder;
  const gzFile file = gzopen((folder / "x.gz").c_str(), "wb");
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
  return BytesOf(folder / "x.gz");
}

std::string Tar() {
  const TemporaryFolder folder;
  WriteTar(folder / "x.tar", {{"a.jsonl", Jsonl(3)}, {"b.jsonl", Jsonl(5)}});
  return BytesOf(folder / "x.tar");
}

// Frames of each clip by name; {} if it is refused.
std::map<std::string, size_t> FramesIn(const std::filesystem::path& path) {
  std::map<std::string, size_t> frames;
  try {
    for (const SkeletonClip& clip : ReadSkeletonClips(path)) {
      frames[clip.name] = clip.sequence.frames.size();
    }
  } catch (const InputError&) {
    frames.clear();
  }
  return frames;
}

struct Sample {
  const char* name;
  std::string bytes;
  std::map<std::string, size_t> right;
};
std::vector<Sample> Samples() {
  return {{"x.jsonl.gz", Gzip(Jsonl(4)), {{"", 4}}},
          {"x.tar.gz", Gzip(Tar()), {{"a", 3}, {"b", 5}}},
          {"x.zip", Zip({{"a.jsonl", Jsonl(3)}, {"b.jsonl", Jsonl(5)}}), {{"a", 3}, {"b", 5}}}};
}

TEST(Archives, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  for (const Sample& sample : Samples()) {
    Put(folder / sample.name, sample.bytes);
    EXPECT_EQ(FramesIn(folder / sample.name), sample.right) << sample.name;
    for (size_t size = 0; size < sample.bytes.size(); ++size) {
      Put(folder / sample.name, sample.bytes.substr(0, size));
      EXPECT_TRUE(FramesIn(folder / sample.name).empty()) << sample.name << " " << size;
    }
  }
}

// Bits that do not affect the content (a time stamp, gzip's file name) may be accepted.
TEST(Archives, WithAnyBitFlippedAreRefusedOrTheSame) {
  const TemporaryFolder folder;
  for (const Sample& sample : Samples()) {
    for (size_t bit = 0; bit < 8 * sample.bytes.size(); ++bit) {
      std::string bytes = sample.bytes;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      Put(folder / sample.name, bytes);
      const auto found = FramesIn(folder / sample.name);
      EXPECT_TRUE(found.empty() || found == sample.right) << sample.name << " byte " << bit / 8;
    }
  }
}

TEST(Archives, ConcatenatedGzipMembersAreRead) {
  const TemporaryFolder folder;
  const std::string all = Jsonl(4);
  const size_t half = all.find('\n', all.size() / 2) + 1;
  Put(folder / "x.gz", Gzip(all.substr(0, half)) + Gzip(all.substr(half)));
  EXPECT_EQ(ReadSkeletons(folder / "x.gz").frames.size(), 4U);
}

TEST(Archives, TrailingBytesOfAGzipAreRefusedUnlessZero) {
  const TemporaryFolder folder;
  Put(folder / "x.gz", Gzip(Jsonl(4)) + std::string(700, '\0'));
  EXPECT_EQ(ReadSkeletons(folder / "x.gz").frames.size(), 4U);
  Put(folder / "x.gz", Gzip(Jsonl(4)) + "rubbish");
  ExpectRefused([&] { ReadSkeletons(folder / "x.gz"); }, "expected a whole archive");
}

TEST(Archives, TarTruncatedBetweenMembersIsRefused) {
  const TemporaryFolder folder;
  const std::string tar = Tar();
  const size_t second = tar.find("b.jsonl");
  Put(folder / "x.tar", tar.substr(0, second));
  ExpectRefused([&] { ReadSkeletonClips(folder / "x.tar"); }, "cut short");
}

// 'tar cf x.tar .' begins names with "./".
TEST(Archives, MembersHaveTheirUnpackedNames) {
  const TemporaryFolder folder;
  WriteTar(folder / "x.tar", {{"./a.jsonl", Jsonl(3)}, {"./sub//b.jsonl", Jsonl(5)}});
  const std::map<std::string, size_t> unpacked = {{"a", 3}, {"sub/b", 5}};
  EXPECT_EQ(FramesIn(folder / "x.tar"), unpacked);
}

TEST(Archives, TooManyMembersAreRefused) {
  const TemporaryFolder folder;
  const std::string member = TarHeader("a.jsonl", 0);
  std::ofstream file(folder / "x.tar", std::ios::binary);
  for (int m = 0; m <= 100000; ++m) file << member;
  file << std::string(1024, '\0') << std::flush;
  ExpectRefused([&] { ReadSkeletonClips(folder / "x.tar"); }, "at most 100000 members");
}

// Its table has 16-bit counts, which overflow.
TEST(Archives, ZipWithTooManyMembersIsRefused) {
  const TemporaryFolder folder;
  std::vector<std::pair<std::string, std::string>> members;
  for (int m = 0; m <= 100000; ++m) members.emplace_back(std::to_string(m), "");
  Put(folder / "x.zip", Zip(members));
  ExpectRefused([&] { ReadSkeletonClips(folder / "x.zip"); }, "members");
}

}  // namespace
}  // namespace ossa::recon
