// UI-PRMD's original texts: Kinect positions with the angles of the same recording, Vicon markers.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/files/marker_centres_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

// Constants: of UI-PRMD's format.

constexpr size_t kJoints = 22;
constexpr size_t kColumns = 3 * kJoints;
constexpr std::array<int, kJoints> kParents = {-1, 0,  1,  2, 3,  4,  3,  6, 7,  8,  3,
                                               10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

// Waist Spine Chest Neck Head HeadTip LCollar LUpperArm LForearm LHand RCollar ... LUpperLeg
// LLowerLeg LFoot LToes RUpperLeg ...: the position of a segment is that of the joint where it
// starts.
constexpr std::array<std::pair<size_t, Joint>, 18> kMap = {{{0, Joint::kHipCenter},
                                                            {1, Joint::kSpine},
                                                            {2, Joint::kShoulderCenter},
                                                            {5, Joint::kHead},
                                                            {7, Joint::kShoulderLeft},
                                                            {8, Joint::kElbowLeft},
                                                            {9, Joint::kWristLeft},
                                                            {11, Joint::kShoulderRight},
                                                            {12, Joint::kElbowRight},
                                                            {13, Joint::kWristRight},
                                                            {14, Joint::kHipLeft},
                                                            {15, Joint::kKneeLeft},
                                                            {16, Joint::kAnkleLeft},
                                                            {17, Joint::kFootLeft},
                                                            {18, Joint::kHipRight},
                                                            {19, Joint::kKneeRight},
                                                            {20, Joint::kAnkleRight},
                                                            {21, Joint::kFootRight}}};

Eigen::Matrix3d ComposeRotation(const double* degrees) {
  const auto turn = [&](int axis) {
    return Eigen::AngleAxisd(degrees[axis] * std::numbers::pi / 180, Eigen::Vector3d::Unit(axis));
  };
  return (turn(2) * turn(0) * turn(1)).toRotationMatrix();
}

// p_i = p_parent + R_parent offset_i, R_i = R_parent Rz Rx Ry: found against Vicon; the data set's
// own viewers use another order, which is 9-16 cm off.
std::array<Eigen::Vector3d, kJoints> Places(const std::vector<double>& offsets,
                                            const std::vector<double>& angles) {
  std::array<Eigen::Vector3d, kJoints> place;
  std::array<Eigen::Matrix3d, kJoints> turn;
  for (size_t i = 0; i < kJoints; ++i) {
    const Eigen::Vector3d offset(&offsets[3 * i]);
    const Eigen::Matrix3d own = ComposeRotation(&angles[3 * i]);
    if (kParents[i] < 0) {
      place[i] = offset;
      turn[i] = own;
      continue;
    }
    const auto parent = static_cast<size_t>(kParents[i]);
    place[i] = place[parent] + turn[parent] * offset;
    turn[i] = turn[parent] * own;
  }
  return place;
}

std::string Replaced(std::string text, std::string_view old, std::string_view fresh) {
  const size_t place = text.rfind(old);
  if (place != std::string::npos) text.replace(place, old.size(), fresh);
  return text;
}

std::string AnglesFor(const SkeletonInput& input) {
  const std::string name =
      Replaced(Replaced(input.name, "Kinect_Positions", "Kinect_Angles"), "_positions", "_angles");
  std::optional<std::string> text;
  if (name != input.name && input.sibling) text = input.sibling(name);
  if (!text) {
    throw InputError(fmt::format(
        "{}: expected the joint angles of the same recording beside it (..._positions.txt and "
        "..._angles.txt, in Kinect_Positions and Kinect_Angles), found none",
        input.name));
  }
  return *text;
}

// Refuses angle files, which only their name distinguishes: Kinect angles have as many columns as
// positions, Vicon angles as many as markers.
void RefuseAngles(const SkeletonInput& input) {
  if (!HoldsAngles(input.name)) return;
  throw InputError(input.name +
                   ": expected places, as in a ..._positions.txt, found the joint angles that "
                   "belong to them");
}

SkeletonSequence ReadKinect(SkeletonInput& input) {
  constexpr double kUsualStep_s = 1.0 / 30.0;
  constexpr double kMetresPerCentimetre = 0.01;
  RefuseAngles(input);
  std::istringstream angle_stream(AnglesFor(input));
  TextLines angles(angle_stream, input.name + " (angles)");
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kUsualStep_s);
  while (lines.NextFilled()) {
    const auto offsets = NumbersIn(lines, Split(lines.line(), ','), kColumns, "x y z of 22 joints");
    angles.Expect("as many lines of angles as of positions");
    const auto degrees =
        NumbersIn(angles, Split(angles.line(), ','), kColumns, "angles of 22 joints");
    const auto places = Places(offsets, degrees);
    BodyRecord body;
    for (const auto& [index, joint] : kMap) {
      // x to the subject's left, z from the subject to the sensor: half a turn makes camera space.
      const Eigen::Vector3d& p = places[index];
      PutJoint(body, joint, kMetresPerCentimetre * Eigen::Vector3d(-p.x(), p.y(), -p.z()));
    }
    const size_t index = sequence.frames.size();
    sequence.frames.push_back(OneBodyFrame(index, static_cast<double>(index) * step_s, body));
  }
  RequireFrames(sequence);
  return sequence;
}

constexpr std::array<const char*, 39> kMarkers = {
    "LFHD", "RFHD", "LBHD", "RBHD", "C7",   "T10",  "CLAV", "STRN", "RBAK", "LSHO",
    "LUPA", "LELB", "LFRM", "LWRA", "LWRB", "LFIN", "RSHO", "RUPA", "RELB", "RFRM",
    "RWRA", "RWRB", "RFIN", "LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB",
    "LANK", "LHEE", "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE"};

SkeletonSequence ReadVicon(SkeletonInput& input) {
  constexpr double kUsualStep_s = 0.01;
  constexpr double kMetresPerMillimetre = 1e-3;
  RefuseAngles(input);
  TextLines lines(input.stream, input.name);
  SkeletonSequence sequence{input.name, {}};
  const double step_s = input.FrameTime_s(kUsualStep_s);
  while (lines.NextFilled()) {
    const auto numbers =
        NumbersIn(lines, Split(lines.line(), ','), 3 * kMarkers.size(), "x y z of 39 markers");
    Markers markers;
    for (size_t m = 0; m < kMarkers.size(); ++m) {
      const Eigen::Vector3d p(&numbers[3 * m]);
      if (p.isZero(0.0)) continue;
      markers[kMarkers[m]] = kMetresPerMillimetre * Eigen::Vector3d(p.x(), p.z(), -p.y());
    }
    const size_t index = sequence.frames.size();
    sequence.frames.push_back(
        OneBodyFrame(index, static_cast<double>(index) * step_s, JointCentres(markers)));
  }
  RequireFrames(sequence);
  return sequence;
}

bool HasColumns(const SkeletonSample& sample, size_t count) {
  if (sample.lines.empty()) return false;
  const auto fields = Split(sample.lines[0], ',');
  return fields.size() == count && std::all_of(fields.begin(), fields.end(), LooksLikeNumber);
}

constexpr SkeletonFormat kUiPrmdFormats[] = {
    {"ui-prmd-kinect", [](const SkeletonSample& s) { return HasColumns(s, kColumns); }, ReadKinect},
    {"ui-prmd-vicon", [](const SkeletonSample& s) { return HasColumns(s, 3 * kMarkers.size()); },
     ReadVicon},
};

}  // namespace

bool HoldsAngles(std::string_view name) {
  if (HasEnding(name, ".gz")) name.remove_suffix(3);
  return HasEnding(name, "_angles.txt");
}

std::span<const SkeletonFormat> UiPrmdFormats() { return kUiPrmdFormats; }

}  // namespace ossa::recon
