// C3D recordings longer than the 16-bit counts of their header.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"
#include "tests/support/temporary_folder.h"

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

/// C3dBytes() with the head 0.6 m above the hips along axis `up` of the file, 1 m and more from the
/// origin.
std::string StandingC3d(size_t up, const std::string& y_screen) {
  std::string bytes = C3dBytes();
  for (size_t f = 0; f < 3; ++f) {
    for (size_t p = 0; p < 2; ++p) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const size_t point = 2 * f + p;
        Put<float>(bytes, 1024 + 16 * point + 4 * axis,
                   axis == up ? 1000.0f + 600.0f * static_cast<float>(p) : 50.0f);
      }
    }
  }
  if (y_screen.empty()) return bytes;
  const std::string nothing(1, '\0');
  const std::string value = std::string{-1, 1, 2} + y_screen + nothing;
  const std::string more =
      std::string{8, 1} + "Y_SCREEN" + Bytes(static_cast<uint16_t>(2 + value.size())) + value;
  return bytes.replace(bytes.find("UNITS") + 5 + 2 + 6, more.size(), more);
}

SkeletonSequence ReadText(const std::string& text) {
  std::istringstream stream(text);
  return ReadSkeletonStream(stream, "file");
}

TEST(C3dUp, IsZUnlessTheScreenParameterDiffers) {
  for (const auto& [up, y_screen] :
       {std::pair{2U, ""}, {2U, "+Z"}, {1U, "+Y"}, {2U, "+Y"}}) {  // the last is wrong
    const auto read = ReadText(StandingC3d(up, y_screen));
    EXPECT_NEAR(At(read, 0, Joint::kHead).y(), 1.6, 1e-6) << up << y_screen;
    EXPECT_NEAR(At(read, 0, Joint::kHipCenter).y(), 1.0, 1e-6) << up << y_screen;
    EXPECT_NEAR(std::abs(At(read, 0, Joint::kHead).z()), 0.05, 1e-6) << up << y_screen;
    EXPECT_TRUE(read.warnings.empty()) << up << y_screen << read.warnings.front();
  }
}

TEST(C3dUp, WarnsIfNobodyStandsUpright) {
  const auto read = ReadText(StandingC3d(1, ""));
  EXPECT_NEAR(At(read, 0, Joint::kHead).z(), -1.6, 1e-6);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("never stands along the axis taken as up"), std::string::npos);
}

// Mappings compare complete names.
TEST(C3dLabels, MayBeFilledWithZeros) {
  std::string bytes = C3dBytes();
  bytes.replace(bytes.find("Head      "), 10, std::string("Hat") + std::string(7, '\0'));
  const ossa::test::TemporaryFolder folder;
  SkeletonReadOptions options;
  options.mapping_file = folder / "names.txt";
  std::ofstream(options.mapping_file) << "HipCenter = HipCenter\nHead = Hat\n";
  std::istringstream stream(bytes);
  const auto read = ReadSkeletonStream(stream, "file", options);
  EXPECT_TRUE(read.frames[0].bodies[0].joints[Index(Joint::kHead)].has_value());
}

TEST(C3dParameters, HaveNamesInAnyCase) {
  std::string bytes = C3dBytes();
  for (const auto& [capitals, small] :
       {std::pair{"LABELS", "Labels"}, {"UNITS", "units"}, {"POINT", "Point"}}) {
    bytes.replace(bytes.find(capitals), std::string(capitals).size(), small);
  }
  EXPECT_LT(
      (At(ReadText(bytes), 0, Joint::kHead) - At(ReadText(C3dBytes()), 0, Joint::kHead)).norm(),
      1e-12);
}

TEST(C3dRate, ComesFromTheParametersIfTheHeaderHasNone) {
  std::string bytes = C3dBytes();
  Put<float>(bytes, 20, 0.0f);
  EXPECT_NE(ComplaintAbout(bytes).find("expected a frame rate, there or in POINT:RATE"),
            std::string::npos);
  const std::string more = NumberRecord(1, "RATE", 4, Bytes(50.0f));
  bytes.replace(bytes.find("UNITS") + 5 + 2 + 6, more.size(), more);
  EXPECT_NEAR(ReadText(bytes).frames.at(1).time_s, 0.02, 1e-9);
}

TEST(LongC3d, FrameCountComesFromTheTrialParameters) {
  EXPECT_EQ(FramesOf(LongC3d(Trial(1, kFrames))), kFrames);
  EXPECT_EQ(FramesOf(LongC3d(Trial(80001, 80000 + 500), 500)), 500u) << "the end of a longer one";
}

TEST(LongC3d, FrameCountComesFromThePointParameters) {
  const std::string count = Bytes(static_cast<float>(kFrames));
  EXPECT_EQ(FramesOf(LongC3d(NumberRecord(1, "FRAMES", 4, count))), kFrames);
  EXPECT_EQ(FramesOf(LongC3d(NumberRecord(1, "LONG_FRAMES", 4, count))), kFrames);
}

TEST(LongC3d, FrameCountComesFromTheHeaderIfNotSaturated) {
  EXPECT_EQ(FramesOf(LongC3d("")), 65535u);
  EXPECT_EQ(FramesOf(LongC3d(Trial(1, 300))), 65535u);
  EXPECT_EQ(FramesOf(LongC3d(NumberRecord(1, "FRAMES", 2, Bytes<uint16_t>(65535)))), 65535u);
}

TEST(LongC3d, MissingFramesAreRefused) {
  const std::string complaint = ComplaintAbout(LongC3d(Trial(1, kFrames), kFrames - 1));
  EXPECT_EQ(complaint, "file: byte 2240992: expected all frames up to byte 2241024");
  const std::string endless = ComplaintAbout(LongC3d(Trial(1, 0xFFFFFFFF), 10));
  EXPECT_NE(endless.find("expected all frames up to byte 137438954464"), std::string::npos)
      << endless;
}

}  // namespace
}  // namespace ossa::recon
