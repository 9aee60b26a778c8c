// Text formats with the 25 joints of the Kinect SDK 2: LabanotationSuite, KERAAL (with its Vicon
// targets), NTU RGB+D. Camera space and metres. Of the 25 joints 20 are used: SpineBase is
// HipCenter, SpineMid is Spine, SpineShoulder is ShoulderCenter, Head is Head; Neck, hand tips and
// thumbs are dropped.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "recon/files/kinect_v2_joints_internal.h"
#include "recon/files/origin_points_internal.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/orientation.h"

namespace ossa::recon {
namespace {

// Constants: of the Kinect SDK 2 and of KERAAL's format.

constexpr size_t kSpineShoulder = 20;

size_t CountNumbers(std::string_view line, char separator) {
  const auto fields = separator == ' ' ? Words(line) : Split(line, separator);
  for (const std::string_view field : fields) {
    if (!IsNan(field) && !LooksLikeNumber(field)) return 0;
  }
  return fields.size();
}

bool FirstLineHas(const SkeletonSample& sample, char separator, size_t numbers) {
  return !sample.lines.empty() && CountNumbers(sample.lines[0], separator) == numbers;
}

TrackingState ParseState(const TextLines& lines, double number) {
  if (number != 0 && number != 1 && number != 2) {
    lines.Fail("a tracking state 0, 1 or 2", fmt::format("{}", number));
  }
  return static_cast<TrackingState>(static_cast<int>(number));
}

// --- LabanotationSuite: ticks of 100 ns, then x, y, z, state of each joint, a comma at the end.

constexpr size_t kLabanColumns = 1 + 4 * kV2Joints;

SkeletonSequence ReadLabanotation(SkeletonInput& input) {
  constexpr double kSecondsPerTick = 1e-7;
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  RowTimes times;
  std::optional<double> first;
  while (lines.NextFilled()) {
    const auto numbers = NumbersIn(lines, Split(lines.line(), ','), kLabanColumns,
                                   "ticks, then x y z state of 25 joints");
    if (!first) first = numbers[0];
    BodyRecord body;
    for (size_t j = 0; j < kV2Joints; ++j) {
      const auto joint = JointOfV2(j);
      const double* values = &numbers[1 + 4 * j];
      const TrackingState state = ParseState(lines, values[3]);
      if (joint) PutJoint(body, *joint, Eigen::Vector3d(values), state);
    }
    const double time_s = (numbers[0] - *first) * kSecondsPerTick;
    times.Take(lines, time_s);
    sequence.frames.push_back(OneBodyFrame(sequence.frames.size(), time_s, std::move(body)));
  }
  RequireFrames(sequence);
  return sequence;
}

// --- KERAAL: 25 times x y z and a quaternion, separated by spaces; no time, no state. Its own
// description says x y z w. The quaternions are w x y z: only then does each y axis lie along its
// bone, as the SDK defines it.

constexpr size_t kKeraalColumns = 7 * kV2Joints;

SkeletonSequence ReadKeraal(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kKinectStep_s);
  while (lines.NextFilled()) {
    const auto numbers = NumbersIn(lines, Words(lines.line()), kKeraalColumns,
                                   "position and quaternion of 25 joints");
    BodyRecord body;
    for (size_t j = 0; j < kV2Joints; ++j) {
      const auto joint = JointOfV2(j);
      const Eigen::Vector3d position(&numbers[7 * j]);
      if (!joint) continue;
      PutJoint(body, *joint, position);
      const double* wxyz = &numbers[7 * j + 3];
      PutSdk2Orientation(body, *joint, {wxyz[0], wxyz[1], wxyz[2], wxyz[3]});
    }
    const size_t index = sequence.frames.size();
    sequence.frames.push_back(OneBodyFrame(index, static_cast<double>(index) * step_s, body));
  }
  RequireFrames(sequence);
  RemoveUnseenAtOrigin(sequence);
  return sequence;
}

// --- KERAAL's Vicon: 17 rigid targets, millimetres, z up, about 60 Hz. Targets are attached to
// limbs, not joints: each stands for the joint at the far end of the limb, with a constant offset
// of 5-18 cm.

constexpr size_t kTargets = 17;  // of the format
constexpr std::array<Joint, kTargets> kTargetJoints = {
    Joint::kWristRight,     Joint::kWristLeft, Joint::kElbowRight, Joint::kElbowLeft,
    Joint::kShoulderCenter, Joint::kKneeRight, Joint::kKneeLeft,   Joint::kShoulderRight,
    Joint::kShoulderLeft,   Joint::kHandRight, Joint::kHandLeft,   Joint::kFootRight,
    Joint::kFootLeft,       Joint::kHipCenter, Joint::kHead,       Joint::kAnkleRight,
    Joint::kAnkleLeft};

SkeletonSequence ReadKeraalVicon(SkeletonInput& input) {
  constexpr double kMetresPerMillimetre = 1e-3;
  constexpr double kViconStep_s = 1.0 / 60.0;  // measured on KERAAL's recordings
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kViconStep_s);
  while (lines.NextFilled()) {
    const auto numbers = NumbersIn(lines, Words(lines.line()), 7 * kTargets,
                                   "position and quaternion of 17 targets");
    BodyRecord body;
    for (size_t t = 0; t < kTargets; ++t) {
      const double* p = &numbers[7 * t];
      if (p[0] == 0 && p[1] == 0 && p[2] == 0) continue;
      PutJoint(body, kTargetJoints[t], kMetresPerMillimetre * Eigen::Vector3d(p[0], p[2], -p[1]));
    }
    const size_t index = sequence.frames.size();
    sequence.frames.push_back(OneBodyFrame(index, static_cast<double>(index) * step_s, body));
  }
  RequireFrames(sequence);
  return sequence;
}

// --- NTU RGB+D `.skeleton`: frame count; per frame a body count; per body a line of ten values
// that starts with its id, the count 25, then one line per joint: x y z, depth and colour pixel,
// quaternion w x y z, state.

bool IsNtu(const SkeletonSample& sample) {
  if (sample.lines.size() < 2 || CountNumbers(sample.lines[0], ' ') != 1 ||
      CountNumbers(sample.lines[1], ' ') != 1) {
    return false;
  }
  // If the first frame has no bodies, another count follows.
  for (size_t i = 2; i < sample.lines.size(); ++i) {
    const size_t numbers = CountNumbers(sample.lines[i], ' ');
    if (numbers != 1) return numbers == 10;
  }
  return true;
}

// The quaternion of a joint's twelve fields; nothing if a part of it is NaN or no number.
std::optional<Eigen::Quaterniond> NtuOrientation(const TextLines& lines,
                                                 const std::vector<std::string_view>& fields) {
  constexpr size_t kW = 7;  // no unit: the quaternion's first field
  std::array<double, 4> wxyz;
  for (size_t i = 0; i < wxyz.size(); ++i) {
    if (!LooksLikeNumber(fields[kW + i])) return std::nullopt;
    wxyz[i] = NumberIn(lines, fields[kW + i], "w, x, y or z of the orientation");
  }
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
}

// Reads the rest of a body after its line of ten values; `id` is the first of these.
BodyRecord ReadNtuBody(TextLines& lines, const std::string& id, std::map<std::string, int>& ids) {
  // Ids are 17-digit numbers; they are renumbered 1, 2, ... in order of appearance.
  const int next = static_cast<int>(ids.size()) + 1;
  BodyRecord body;
  body.id = ids.try_emplace(id, next).first->second;
  lines.Expect("the count of joints");
  WholeNumberIn(lines, Trimmed(lines.line()), "the count of joints", kV2Joints, kV2Joints);
  for (size_t j = 0; j < kV2Joints; ++j) {
    lines.Expect(fmt::format("joint {} of 25", j + 1));
    const auto fields = Words(lines.line());
    if (fields.size() != 12) lines.Fail("12 values of a joint", lines.line());
    const auto joint = JointOfV2(j);
    if (!joint) continue;
    // All values may be NaN if the joint was not seen; pixels are not used.
    const auto place = PlaceIn(lines, {fields[0], fields[1], fields[2]}, "x, y or z");
    if (!place || IsNan(fields[11])) continue;
    PutJoint(body, *joint, *place, ParseState(lines, NumberIn(lines, fields[11], "the state")));
    if (const auto wxyz = NtuOrientation(lines, fields)) PutSdk2Orientation(body, *joint, *wxyz);
  }
  return body;
}

// Ignores the counts, which are often wrong: a body starts with a line of ten values, a frame with
// one value.
class NtuReader {
 public:
  explicit NtuReader(SkeletonInput& input)
      : lines_(input.stream, input.name),
        step_s_(input.FrameTime_s(kKinectStep_s)),
        sequence_{input.name, {}} {}

  SkeletonSequence Run() {
    lines_.Expect("the count of frames");
    const long frames = Count("the count of frames");
    while (lines_.NextFilled()) {
      const auto words = Words(lines_.line());
      if (words.size() == 1) {
        BeginFrame(Count("the count of bodies"));
      } else if (words.size() == 10 && !sequence_.frames.empty()) {
        const std::string id(words[0]);
        const auto& body =
            sequence_.frames.back().bodies.emplace_back(ReadNtuBody(lines_, id, ids_));
        nan_joints_ += static_cast<size_t>(
            std::count_if(body.joints.begin(), body.joints.end(),
                          [](const auto& joint) { return !joint.has_value(); }));
      } else {
        lines_.Fail("the count of bodies of a frame or the ten values of a body", lines_.line());
      }
    }
    EndFrame();
    RequireFrames(sequence_);
    Warn(frames);
    return std::move(sequence_);
  }

 private:
  long Count(const char* what) const {
    constexpr long kMost = 10000000;  // by hand: no recording is as long
    return WholeNumberIn(lines_, Trimmed(lines_.line()), what, 0, kMost);
  }

  void BeginFrame(long bodies) {
    EndFrame();
    SkeletonFrame& frame = sequence_.frames.emplace_back();
    frame.frame = static_cast<int64_t>(sequence_.frames.size()) - 1;
    frame.time_s = static_cast<double>(frame.frame) * step_s_;
    bodies_said_ = static_cast<size_t>(bodies);
  }

  void EndFrame() {
    if (sequence_.frames.empty() || sequence_.frames.back().bodies.size() == bodies_said_) return;
    if (wrong_frames_++ == 0) first_wrong_ = sequence_.frames.back().frame;
  }

  void Warn(long frames_said) {
    if (static_cast<size_t>(frames_said) != sequence_.frames.size()) {
      sequence_.warnings.push_back(
          fmt::format("{}: line 1 counts {} frames, the file has {}: those are read",
                      lines_.source(), frames_said, sequence_.frames.size()));
    }
    if (nan_joints_ > 0) {
      sequence_.warnings.push_back(fmt::format("{}: {} joints are NaN: they count as not seen",
                                               lines_.source(), nan_joints_));
    }
    if (wrong_frames_ > 0) {
      sequence_.warnings.push_back(
          fmt::format("{}: in {} frames, the first of them {}, there are more or fewer bodies than "
                      "their count says: those that are there are read",
                      lines_.source(), wrong_frames_, first_wrong_));
    }
  }

  TextLines lines_;
  double step_s_;
  SkeletonSequence sequence_;
  std::map<std::string, int> ids_;
  size_t bodies_said_ = 0;
  size_t nan_joints_ = 0;
  size_t wrong_frames_ = 0;
  int64_t first_wrong_ = 0;
};

SkeletonSequence ReadNtu(SkeletonInput& input) { return NtuReader(input).Run(); }

constexpr SkeletonFormat kKinectV2Formats[] = {
    {"labanotation-csv",
     [](const SkeletonSample& s) { return FirstLineHas(s, ',', kLabanColumns); }, ReadLabanotation},
    {"keraal-kinect", [](const SkeletonSample& s) { return FirstLineHas(s, ' ', kKeraalColumns); },
     ReadKeraal},
    {"keraal-vicon", [](const SkeletonSample& s) { return FirstLineHas(s, ' ', 7 * kTargets); },
     ReadKeraalVicon},
    {"ntu", IsNtu, ReadNtu},
};

}  // namespace

// The first twenty are SDK 1's, except for Neck in place of ShoulderCenter.
std::optional<Joint> JointOfV2(size_t joint) {
  if (joint == kSpineShoulder) return Joint::kShoulderCenter;
  if (joint == 2 || joint > kSpineShoulder) return std::nullopt;
  return static_cast<Joint>(joint);
}

void PutSdk2Orientation(BodyRecord& body, Joint joint, const Eigen::Quaterniond& sdk2) {
  constexpr double kUnit = 1e-2;  // share of the length
  if (std::abs(sdk2.norm() - 1) < kUnit) {
    body.joints[joint]->orientation = OrientationFromSdk2(joint, sdk2.normalized());
  }
}

std::span<const SkeletonFormat> KinectV2Formats() { return kKinectV2Formats; }

}  // namespace ossa::recon
