// Skeletons of action data sets as the Kinect SDKs gave them: MSRC-12, MSR Daily Activity 3D,
// PKU-MMD. Camera space and metres, without tracking states.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "recon/files/kinect_v2_joints_internal.h"
#include "recon/files/origin_points_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

// How many numbers a line has; 0 if it has anything else.
size_t CountNumbers(std::string_view line) {
  const auto words = Words(line);
  return std::all_of(words.begin(), words.end(), LooksLikeNumber) ? words.size() : 0;
}

bool FirstLineHas(const SkeletonSample& sample, size_t numbers) {
  return !sample.lines.empty() && CountNumbers(sample.lines[0]) == numbers;
}

// Joints without a position are written as the origin; somebody who was not seen is all zeros.
bool IsSeen(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && !joint->position_m.isZero(); });
}

SkeletonFrame& AddFrame(SkeletonSequence& sequence, double time_s) {
  SkeletonFrame& frame = sequence.frames.emplace_back();
  frame.frame = static_cast<int64_t>(sequence.frames.size()) - 1;
  frame.time_s = time_s;
  return frame;
}

void AddIfSeen(SkeletonFrame& frame, int id, BodyRecord body) {
  if (!IsSeen(body)) return;
  body.id = id;
  for (auto& joint : body.joints) {
    if (joint && joint->position_m.isZero()) joint.reset();
  }
  frame.bodies.push_back(std::move(body));
}

// --- MSRC-12 (Microsoft Research Cambridge): ticks, then x y z and another number of the 20 joints
// of SDK 1, separated by blanks.

constexpr size_t kMsrcColumns = 1 + 4 * kJointCount;

SkeletonSequence ReadMsrc12(SkeletonInput& input) {
  constexpr double kTicksPerSecond = 49.875e6;  // Hz; of the format
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  RowTimes times;
  std::optional<double> first;
  while (lines.NextFilled()) {
    const auto numbers = NumbersIn(lines, Words(lines.line()), kMsrcColumns,
                                   "ticks, then four numbers of each of 20 joints");
    if (!first) first = numbers[0];
    BodyRecord body;
    for (size_t j = 0; j < kJointCount; ++j) {
      PutJoint(body, static_cast<Joint>(j), Eigen::Vector3d(&numbers[1 + 4 * j]));
    }
    const double time_s = (numbers[0] - *first) / kTicksPerSecond;
    times.Take(lines, time_s);
    AddIfSeen(AddFrame(sequence, time_s), 1, std::move(body));
  }
  RequireFrames(sequence);
  return sequence;
}

// --- MSR Daily Activity 3D: the counts of frames and joints; for each frame the count of its rows,
// 40 a person; two rows a joint, x y z in space, then u v and depth, each with a confidence that
// the data set calls useless.

constexpr size_t kDailyRows = 2 * kJointCount;
constexpr size_t kDailyRowNumbers = 4;  // of the format

bool IsMsrDaily(const SkeletonSample& sample) {
  if (sample.lines.size() < 2 + kDailyRows || !FirstLineHas(sample, 2)) return false;
  if (Words(sample.lines[0])[1] != std::to_string(kJointCount)) return false;
  const auto is_row = [](std::string_view line) { return CountNumbers(line) == kDailyRowNumbers; };
  const auto row = std::find_if(sample.lines.begin() + 1, sample.lines.end(), is_row);
  return std::all_of(sample.lines.begin() + 1, row,
                     [](std::string_view line) { return CountNumbers(line) == 1; });
}

BodyRecord ReadMsrDailyBody(TextLines& lines) {
  BodyRecord body;
  for (size_t row = 0; row < kDailyRows; ++row) {
    lines.Expect(fmt::format("row {} of a person's {}", row + 1, kDailyRows));
    const auto numbers = NumbersIn(lines, Words(lines.line()), kDailyRowNumbers,
                                   "x y z confidence, or u v depth confidence");
    const bool is_in_space = row % 2 == 0;
    if (is_in_space) PutJoint(body, static_cast<Joint>(row / 2), Eigen::Vector3d(numbers.data()));
  }
  return body;
}

SkeletonSequence ReadMsrDaily(SkeletonInput& input) {
  constexpr long kMostRows = 6 * static_cast<long>(kDailyRows);  // the SDK's six people
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kKinectStep_s);
  lines.Expect("the counts of frames and joints");
  const double counted =
      NumbersIn(lines, Words(lines.line()), 2, "the counts of frames and joints")[0];
  while (lines.NextFilled()) {
    const long rows = WholeNumberIn(lines, Trimmed(lines.line()), "a count of rows", 0, kMostRows);
    if (rows % static_cast<long>(kDailyRows) != 0) {
      lines.Fail(fmt::format("a count of rows, {} a person", kDailyRows), lines.line());
    }
    const size_t index = sequence.frames.size();
    SkeletonFrame& frame = AddFrame(sequence, static_cast<double>(index) * step_s);
    for (long body = 0; body < rows / static_cast<long>(kDailyRows); ++body) {
      AddIfSeen(frame, static_cast<int>(body) + 1, ReadMsrDailyBody(lines));
    }
  }
  RequireFrames(sequence);
  if (counted != static_cast<double>(sequence.frames.size())) {
    sequence.warnings.push_back(
        fmt::format("{}: line 1 counts {:g} frames, the file has {}: those "
                    "are read",
                    input.name, counted, sequence.frames.size()));
  }
  return sequence;
}

// --- PKU-MMD: a row a frame, 30 a second: x y z of the 25 joints of SDK 2 of two people, of whom
// the second is often zeros.

constexpr size_t kPkuPeople = 2;  // of the format
constexpr size_t kPkuColumns = kPkuPeople * 3 * kV2Joints;

SkeletonSequence ReadPkuMmd(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kKinectStep_s);
  while (lines.NextFilled()) {
    const auto numbers =
        NumbersIn(lines, Words(lines.line()), kPkuColumns, "x y z of 25 joints of two people");
    const size_t index = sequence.frames.size();
    SkeletonFrame& frame = AddFrame(sequence, static_cast<double>(index) * step_s);
    for (size_t person = 0; person < kPkuPeople; ++person) {
      BodyRecord body;
      for (size_t j = 0; j < kV2Joints; ++j) {
        const Eigen::Vector3d position(&numbers[3 * (person * kV2Joints + j)]);
        if (const auto joint = JointOfV2(j)) PutJoint(body, *joint, position);
      }
      AddIfSeen(frame, static_cast<int>(person) + 1, std::move(body));
    }
  }
  RequireFrames(sequence);
  return sequence;
}

constexpr SkeletonFormat kDataSetFormats[] = {
    {"msrc-12", [](const SkeletonSample& s) { return FirstLineHas(s, kMsrcColumns); }, ReadMsrc12},
    {"msr-daily-activity", IsMsrDaily, ReadMsrDaily},
    {"pku-mmd", [](const SkeletonSample& s) { return FirstLineHas(s, kPkuColumns); }, ReadPkuMmd},
};

}  // namespace

std::span<const SkeletonFormat> DataSetFormats() { return kDataSetFormats; }

}  // namespace ossa::recon
