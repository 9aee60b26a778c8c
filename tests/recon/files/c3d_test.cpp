// C3D recordings that are longer than the 16 bits of their header can say.
#include <gtest/gtest.h>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"

namespace ossa::recon {
namespace {

constexpr size_t kFrames = 70000;
constexpr size_t kFrameBytes = 2 * 4 * sizeof(float);

template <typename T>
std::string Bytes(T value) {
  std::string bytes(sizeof(T), '\0');
  Put(bytes, 0, value);
  return bytes;
}

std::string GroupRecord(char id, const std::string& name) {
  const std::string nothing(1, '\0');
  return std::string{static_cast<char>(name.size()), static_cast<char>(-id)} + name +
         Bytes<uint16_t>(3) + nothing;
}

/// A number, or several of one type: as many bytes each as `type` says.
std::string NumberRecord(char id, const std::string& name, char type, const std::string& data) {
  const size_t count = data.size() / static_cast<size_t>(type);
  const std::string value = std::string{type, 1, static_cast<char>(count)} + data + '\0';
  return std::string{static_cast<char>(name.size()), id} + name +
         Bytes(static_cast<uint16_t>(2 + value.size())) + value;
}

/// C3dBytes() with more parameters, and frames as many as `frames`: the header says 65535.
std::string LongC3d(const std::string& more, size_t frames = kFrames) {
  std::string bytes = C3dBytes();
  Put<uint16_t>(bytes, 8, 65535);
  bytes.replace(bytes.find("UNITS") + 5 + 2 + 6, more.size(), more);
  const std::string frame = bytes.substr(1024, kFrameBytes);
  bytes.resize(1024);
  for (size_t f = 0; f < frames; ++f) bytes += frame;
  return bytes;
}

std::string Words(size_t value) { return Bytes(static_cast<uint32_t>(value)); }  // the lower first

std::string Trial(size_t start, size_t end) {
  return GroupRecord(2, "TRIAL") + NumberRecord(2, "ACTUAL_START_FIELD", 2, Words(start)) +
         NumberRecord(2, "ACTUAL_END_FIELD", 2, Words(end));
}

size_t FramesOf(const std::string& text) {
  std::istringstream stream(text);
  return ReadSkeletonStream(stream, "file").frames.size();
}

TEST(LongC3d, HasAsManyFramesAsItsTrialSays) {
  EXPECT_EQ(FramesOf(LongC3d(Trial(1, kFrames))), kFrames);
  EXPECT_EQ(FramesOf(LongC3d(Trial(80001, 80000 + 500), 500)), 500u) << "the end of a longer one";
}

TEST(LongC3d, HasAsManyFramesAsItsPointsSay) {
  const std::string count = Bytes(static_cast<float>(kFrames));
  EXPECT_EQ(FramesOf(LongC3d(NumberRecord(1, "FRAMES", 4, count))), kFrames);
  EXPECT_EQ(FramesOf(LongC3d(NumberRecord(1, "LONG_FRAMES", 4, count))), kFrames);
}

TEST(LongC3d, IsAsTheHeaderSaysWhereThatIsEnough) {
  EXPECT_EQ(FramesOf(LongC3d("")), 65535u);
  EXPECT_EQ(FramesOf(LongC3d(Trial(1, 300))), 65535u);
  EXPECT_EQ(FramesOf(LongC3d(NumberRecord(1, "FRAMES", 2, Bytes<uint16_t>(65535)))), 65535u);
}

TEST(LongC3d, IsRefusedWhereFramesAreMissing) {
  const std::string complaint = ComplaintAbout(LongC3d(Trial(1, kFrames), kFrames - 1));
  EXPECT_EQ(complaint, "file: byte 2240992: expected all frames up to byte 2241024");
  const std::string endless = ComplaintAbout(LongC3d(Trial(1, 0xFFFFFFFF), 10));
  EXPECT_NE(endless.find("expected all frames up to byte 137438954464"), std::string::npos)
      << endless;
}

}  // namespace
}  // namespace ossa::recon
