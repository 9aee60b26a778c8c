// Text formats with the 20 joints of the Kinect SDK 1: KinectGait, MSR Action3D, UTKinect-Action3D.
// All are in camera space and metres already; none has tracking states: joints that were not seen
// are written as the origin.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "recon/files/joint_names_internal.h"
#include "recon/files/origin_points_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

bool AllNumbers(const std::vector<std::string_view>& words) {
  return std::all_of(words.begin(), words.end(), LooksLikeNumber);
}

// --- KinectGait: `Name;x;y;z`, one joint per line; a frame ends when its first name is repeated.

bool IsKinectGait(const SkeletonSample& sample) {
  if (sample.lines.empty()) return false;
  const auto fields = Split(sample.lines[0], ';');
  return fields.size() == 4 && FindJointByName(fields[0]).has_value();
}

void RequireWholeFrame(const TextLines& lines, const BodyRecord& body) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!body.joints[j]) {
      lines.Fail(fmt::format("{} before the next frame", kJointNames[j]), lines.line());
    }
  }
}

SkeletonSequence ReadKinectGait(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kKinectStep_s);
  std::optional<Joint> first;
  BodyRecord body;
  const auto finish = [&] {
    RequireWholeFrame(lines, body);
    const size_t index = sequence.frames.size();
    sequence.frames.push_back(OneBodyFrame(index, static_cast<double>(index) * step_s, body));
    body = BodyRecord{};
  };
  while (lines.NextFilled()) {
    const auto fields = Split(lines.line(), ';');
    if (fields.size() != 4) lines.Fail("Name;x;y;z", lines.line());
    const auto joint = FindJointByName(fields[0]);
    if (!joint) lines.Fail("the name of one of the 20 SDK joints", fields[0]);
    if (!first) first = joint;
    auto& record = body.joints[*joint];
    if (record && joint == first) finish();
    if (record) lines.Fail("each joint once a frame", fields[0]);
    PutJoint(body, *joint,
             {NumberIn(lines, fields[1], "x"), NumberIn(lines, fields[2], "y"),
              NumberIn(lines, fields[3], "z")});
  }
  if (first) finish();
  RequireFrames(sequence);
  RemoveUnseenAtOrigin(sequence);
  return sequence;
}

// --- MSR Action3D ("Real3D" files): `x y z confidence`, 20 lines a frame, in an order of its own.

constexpr JointArray<Joint> kMsrOrder = {
    Joint::kShoulderRight, Joint::kShoulderLeft, Joint::kShoulderCenter, Joint::kSpine,
    Joint::kHipRight,      Joint::kHipLeft,      Joint::kHipCenter,      Joint::kElbowRight,
    Joint::kElbowLeft,     Joint::kWristRight,   Joint::kWristLeft,      Joint::kHandRight,
    Joint::kHandLeft,      Joint::kKneeRight,    Joint::kKneeLeft,       Joint::kAnkleRight,
    Joint::kAnkleLeft,     Joint::kFootRight,    Joint::kFootLeft,       Joint::kHead};

bool IsMsrAction3D(const SkeletonSample& sample) {
  if (sample.lines.size() < kJointCount) return false;
  return std::all_of(sample.lines.begin(), sample.lines.begin() + kJointCount,
                     [](std::string_view line) {
                       const auto words = Words(line);
                       return words.size() == 4 && AllNumbers(words);
                     });
}

SkeletonSequence ReadMsrAction3D(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kKinectStep_s);
  while (lines.NextFilled()) {
    BodyRecord body;
    for (size_t row = 0; row < kJointCount; ++row) {
      if (row > 0) lines.Expect(fmt::format("line {} of the frame's 20", row + 1));
      const auto numbers = NumbersIn(lines, Words(lines.line()), 4, "x y z confidence");
      if (numbers[3] < 0 || numbers[3] > 1) {
        lines.Fail("a confidence from 0 to 1 in column 4", lines.line());
      }
      PutJoint(body, kMsrOrder[row], Eigen::Vector3d(numbers.data()));
      body.joints[Index(kMsrOrder[row])]->confidence = numbers[3];
    }
    const size_t index = sequence.frames.size();
    sequence.frames.push_back(OneBodyFrame(index, static_cast<double>(index) * step_s, body));
  }
  RequireFrames(sequence);
  RemoveUnseenAtOrigin(sequence);
  return sequence;
}

// --- UTKinect-Action3D: frame number, then x y z of the 20 joints in SDK order; frames are
// numbered at 30 Hz, with gaps and some duplicates.

constexpr size_t kUtColumns = 1 + 3 * kJointCount;

bool IsUtKinect(const SkeletonSample& sample) {
  if (sample.lines.empty()) return false;
  const auto words = Words(sample.lines[0]);
  return words.size() == kUtColumns && AllNumbers(words);
}

SkeletonSequence ReadUtKinect(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kKinectStep_s);
  std::optional<double> first;
  while (lines.NextFilled()) {
    const auto numbers =
        NumbersIn(lines, Words(lines.line()), kUtColumns, "frame, then x y z of 20 joints");
    if (!first) first = numbers[0];
    BodyRecord body;
    for (size_t j = 0; j < kJointCount; ++j) {
      PutJoint(body, static_cast<Joint>(j), Eigen::Vector3d(&numbers[1 + 3 * j]));
    }
    const double time_s = (numbers[0] - *first) * step_s;
    if (!sequence.frames.empty() && sequence.frames.back().time_s == time_s) continue;
    if (!sequence.frames.empty() && time_s < sequence.frames.back().time_s) {
      lines.Fail("frame numbers that grow", lines.line());
    }
    sequence.frames.push_back(OneBodyFrame(sequence.frames.size(), time_s, std::move(body)));
  }
  RequireFrames(sequence);
  RemoveUnseenAtOrigin(sequence);
  return sequence;
}

constexpr SkeletonFormat kKinectV1Formats[] = {
    {"kinect-gait", IsKinectGait, ReadKinectGait},
    {"ut-kinect", IsUtKinect, ReadUtKinect},
    {"msr-action3d", IsMsrAction3D, ReadMsrAction3D},
};

}  // namespace

std::span<const SkeletonFormat> KinectV1Formats() { return kKinectV1Formats; }

}  // namespace ossa::recon
