// Our unfinished recordings, and what distinguishes them from damaged ones.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_codec_internal.h"
#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/oni_recorder.h"
#include "tests/support/depth_examples.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using std::chrono::milliseconds;
using test::ExampleFrame;
using test::TemporaryFolder;

constexpr int kFrames = 3;

std::string BytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void Put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string Recording(const std::filesystem::path& path) {
  OniRecorder recorder(path, ExampleFrame(0, 8, 6).camera);
  for (int i = 0; i < kFrames; ++i) recorder.Write(ExampleFrame(i, 8, 6));
  recorder.Finish();
  return BytesOf(path);
}

// Bytes before the first frame.
size_t HeadOf(const std::string& bytes) {
  return ParseOniPreamble({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}).size;
}

// The frames that can be read, each of which must equal the original, and the first error.
struct Outcome {
  int frames = 0;
  int notes = 0;
  std::string error;
};
Outcome ReadFrames(const std::filesystem::path& path) {
  Outcome outcome;
  SourceOptions options;
  options.note = [&outcome](NoteKind, const std::string&) { ++outcome.notes; };
  try {
    const auto source = OpenSource(path.string(), options);
    for (;;) {
      const ReadResult result = source->Read(milliseconds(60000));
      if (result.status != ReadStatus::kFrame) break;
      const DepthFrame right = ExampleFrame(outcome.frames++, 8, 6);
      EXPECT_EQ(result.frame.depth_mm, right.depth_mm);
      EXPECT_NEAR(result.frame.time_s, right.time_s, 1e-6);  // whole microseconds
      EXPECT_EQ(result.frame.camera, right.camera);
    }
  } catch (const InputError& error) {
    outcome.error = error.what();
  }
  return outcome;
}

TEST(UnfinishedOni, IsReadUnderItsTemporaryName) {
  const TemporaryFolder folder;
  OniRecorder recorder(folder / "x.oni", ExampleFrame(0, 8, 6).camera);
  for (int i = 0; i < kFrames; ++i) recorder.Write(ExampleFrame(i, 8, 6));
  const std::filesystem::directory_iterator only(folder.path());
  EXPECT_TRUE(IsRecording(only->path())) << only->path();
  const Outcome outcome = ReadFrames(only->path());
  EXPECT_EQ(outcome.frames, kFrames) << outcome.error;
  EXPECT_EQ(outcome.notes, 1);
}

// At every position: complete frames are read, with a note; without any, a one-line error.
TEST(UnfinishedOni, EveryTruncationKeepsTheCompleteFrames) {
  const TemporaryFolder folder;
  const std::string whole = Recording(folder / "x.oni");
  const size_t head = HeadOf(whole);
  for (size_t size = head; size < whole.size(); ++size) {
    Put(folder / "x.oni", whole.substr(0, size));
    const Outcome outcome = ReadFrames(folder / "x.oni");
    EXPECT_EQ(outcome.notes, outcome.frames > 0 ? 1 : 0) << size;
    EXPECT_EQ(outcome.error.empty(), outcome.frames > 0) << size << outcome.error;
  }
  EXPECT_EQ(ReadFrames(folder / "x.oni").frames, kFrames) << "all but the last byte";
}

TEST(UnfinishedOni, TruncatedHeaderIsOneLine) {
  const TemporaryFolder folder;
  const std::string whole = Recording(folder / "x.oni");
  const size_t first_name = whole.find(kOniCameraProperty) + std::strlen(kOniCameraProperty);
  for (size_t size = first_name; size < HeadOf(whole); ++size) {
    Put(folder / "x.oni", whole.substr(0, size));
    EXPECT_THROW(CheckOniFile(folder / "x.oni"), InputError) << size;
  }
}

TEST(UnfinishedOni, WithoutItsSealIsComplete) {
  const TemporaryFolder folder;
  std::string bytes = Recording(folder / "x.oni");
  const size_t value = bytes.find(kOniSealProperty) + std::strlen(kOniSealProperty) + 1 + 4;
  bytes.replace(value, sizeof(uint64_t), sizeof(uint64_t), '\0');
  Put(folder / "x.oni", bytes);
  EXPECT_EQ(ReadFrames(folder / "x.oni").frames, kFrames);
}

// The following frames are still read: they may be all that the user has.
TEST(UnfinishedOni, ReportsADamagedFrameAndReadsOn) {
  const TemporaryFolder folder;
  std::string bytes = Recording(folder / "x.oni");
  bytes.pop_back();  // it was cut
  Put(folder / "x.oni", bytes);
  const OniFile file = CheckOniFile(folder / "x.oni");
  bytes[file.unfinished->at(0).data_at] ^= 1;  // the number of different depths
  Put(folder / "x.oni", bytes);
  const auto source = OpenSource((folder / "x.oni").string());
  test::ExpectRefused([&] { source->Read(milliseconds(0)); }, "frame 0: its depth is damaged");
  EXPECT_EQ(source->Read(milliseconds(0)).frame.depth_mm, ExampleFrame(1, 8, 6).depth_mm);
}

// A damaged length must not look like truncation, nor other damage like a foreign file.
TEST(SealedOni, RefusesAnyFlippedBit) {
  const TemporaryFolder folder;
  const std::string whole = Recording(folder / "x.oni");
  for (size_t byte = 0; byte < whole.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = whole;
      bytes[byte] = static_cast<char>(bytes[byte] ^ (1 << bit));
      Put(folder / "x.oni", bytes);
      EXPECT_THROW(CheckOniFile(folder / "x.oni"), InputError) << "byte " << byte << " bit " << bit;
    }
  }
}

TEST(SealedOni, DamagedSealNameIsReportedAsDamage) {
  const TemporaryFolder folder;
  std::string bytes = Recording(folder / "x.oni");
  bytes[bytes.find(kOniSealProperty)] = 'X';
  Put(folder / "x.oni", bytes);
  test::ExpectRefused([&] { CheckOniFile(folder / "x.oni"); }, "the recording is damaged");
}

TEST(OniCodec, DecodesWhatItEncodes) {
  std::mt19937 random(3);
  for (const int values : {1, 2, 7, 40, 300, 30000}) {
    std::vector<uint16_t> depth_mm(1001), back;  // an odd number: the last pixel stands alone
    uint16_t value = 0;
    for (uint16_t& pixel : depth_mm) {
      if (random() % 3 == 0)
        value = static_cast<uint16_t>(random() % static_cast<unsigned>(values));
      pixel = value;
    }
    std::vector<uint8_t> data;
    ASSERT_TRUE(EncodeOniDepth(depth_mm, &data));
    EXPECT_TRUE(DecodeOniDepth(data, depth_mm.size(), &back));
    EXPECT_EQ(back, depth_mm);
    EXPECT_FALSE(DecodeOniDepth(data, depth_mm.size() - 1, &back));
    EXPECT_FALSE(DecodeOniDepth(data, depth_mm.size() + 1, &back));
  }
}

}  // namespace
}  // namespace ossa::depth
