// Points at the origin: not seen, or the joint to which all others are relative.
#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/files/skeleton_texts.h"

namespace ossa::recon {
namespace {

/// C3dBytes() with its three HipCenter points at `hips_mm`, and the last Head marked as `residual`.
std::string C3dWithHips(const std::array<Eigen::Vector3f, 3>& hips_mm, float residual) {
  std::string bytes = C3dBytes();
  for (size_t f = 0; f < hips_mm.size(); ++f) {
    for (size_t axis = 0; axis < 3; ++axis) {
      Put<float>(bytes, 1024 + 32 * f + 4 * axis, hips_mm[f][static_cast<Eigen::Index>(axis)]);
    }
  }
  Put<float>(bytes, 1024 + 32 * 2 + 16 + 12, residual);
  return bytes;
}

/// C3dWithHips() with Head 0.25 m above the origin in all frames.
std::string C3dRelativeToHips(const std::array<Eigen::Vector3f, 3>& hips_mm, float residual) {
  std::string bytes = C3dWithHips(hips_mm, residual);
  for (size_t f = 0; f < 3; ++f) {
    const std::array<float, 3> head_mm = {0.0f, 0.0f, 250.0f};
    for (size_t axis = 0; axis < 3; ++axis) {
      Put<float>(bytes, 1024 + 32 * f + 16 + 4 * axis, head_mm[axis]);
    }
  }
  return bytes;
}

bool HasJoint(const SkeletonSequence& read, size_t frame, Joint joint) {
  return read.frames.at(frame).bodies.at(0).joints[joint].has_value();
}

constexpr float kSeen = 0.0f, kUnseen = -1.0f;  // residuals of C3D
const Eigen::Vector3f kOrigin(0, 0, 0), kBeside(10, 0, 0);

TEST(C3dOrigin, IsAPlaceInFilesThatMarkUnseenPoints) {
  const auto read = ReadText(C3dWithHips({kOrigin, kBeside, kBeside}, kUnseen));
  ASSERT_TRUE(HasJoint(read, 0, Joint::kHipCenter));
  EXPECT_EQ(At(read, 0, Joint::kHipCenter), Eigen::Vector3d(0, 0, 0));
  EXPECT_FALSE(HasJoint(read, 2, Joint::kHead));
}

TEST(C3dOrigin, IsAnUnseenPointInFilesThatMarkNone) {
  const auto read = ReadText(C3dWithHips({kOrigin, kBeside, kBeside}, kSeen));
  EXPECT_FALSE(HasJoint(read, 0, Joint::kHipCenter));
  EXPECT_TRUE(HasJoint(read, 1, Joint::kHipCenter));
  EXPECT_TRUE(HasJoint(read, 2, Joint::kHead));
}

TEST(C3dOrigin, IsAPlaceInAllFramesIfTheOthersAreAroundIt) {
  const auto around = ReadText(C3dRelativeToHips({kOrigin, kOrigin, kOrigin}, kSeen));
  EXPECT_TRUE(HasJoint(around, 1, Joint::kHipCenter));
  const auto far = ReadText(C3dWithHips({kOrigin, kOrigin, kOrigin}, kSeen));
  EXPECT_FALSE(HasJoint(far, 1, Joint::kHipCenter)) << "the head is 1 m away";
}

/// Two frames of the 20 joints of the Kinect SDK 1: `first` is joint 0 of the first frame, `second`
/// that of the second, `others` all others.
using Sdk1Text = std::string (*)(const std::string& first, const std::string& second,
                                 const std::string& others);

std::string GaitFrames(const std::string& first, const std::string& second,
                       const std::string& others) {
  std::string text;
  for (const std::string& head : {first, second}) {
    for (size_t j = 0; j < 20; ++j) {
      text +=
          std::string(kGaitNames[j]) + ";" + ReplacedAll(j == 0 ? head : others, " ", ";") + "\n";
    }
  }
  return text;
}

std::string MsrFrames(const std::string& first, const std::string& second,
                      const std::string& others) {
  std::string text;
  for (const std::string& head : {first, second}) {
    for (size_t row = 0; row < 20; ++row) text += (row == 19 ? head : others) + " 0.9\n";
  }
  return text;
}

std::string UtFrames(const std::string& first, const std::string& second,
                     const std::string& others) {
  std::string text;
  for (const std::string& head : {first, second}) {
    text += text.empty() ? "1" : "2";
    for (size_t j = 0; j < 20; ++j) text += " " + (j == Index(Joint::kHead) ? head : others);
    text += "\n";
  }
  return text;
}

std::string KeraalFrames(const std::string& first, const std::string& second,
                         const std::string& others) {
  std::string text;
  for (const std::string& head : {first, second}) {
    for (size_t j = 0; j < 25; ++j) {
      text += (j == Index(Joint::kHead) ? head : others) + " 1 0 0 0 ";
    }
    text += "\n";
  }
  return text;
}

class Sdk1Origin : public testing::TestWithParam<std::pair<const char*, Sdk1Text>> {};

TEST_P(Sdk1Origin, IsAnUnseenJointOrTheRoot) {
  const Sdk1Text text = GetParam().second;
  const std::string origin = "0 0 0", near = "0.1 0.2 0", camera = "0.1 0.2 2";
  const auto lost = ReadText(text(camera, origin, camera));
  EXPECT_TRUE(HasJoint(lost, 0, Joint::kHead));
  EXPECT_FALSE(HasJoint(lost, 1, Joint::kHead));
  EXPECT_TRUE(HasJoint(lost, 1, Joint::kSpine));
  const auto root = ReadText(text(origin, origin, near));
  EXPECT_TRUE(HasJoint(root, 0, Joint::kHead) && HasJoint(root, 1, Joint::kHead));
  const auto never = ReadText(text(origin, origin, camera));
  EXPECT_FALSE(HasJoint(never, 0, Joint::kHead) || HasJoint(never, 1, Joint::kHead));
}

INSTANTIATE_TEST_SUITE_P(Formats, Sdk1Origin,
                         testing::Values(std::pair{"KinectGait", Sdk1Text{GaitFrames}},
                                         std::pair{"MsrAction3D", Sdk1Text{MsrFrames}},
                                         std::pair{"UtKinect", Sdk1Text{UtFrames}},
                                         std::pair{"Keraal", Sdk1Text{KeraalFrames}}),
                         [](const auto& info) { return std::string(info.param.first); });

}  // namespace
}  // namespace ossa::recon
