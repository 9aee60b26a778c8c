#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace ossa::recon::test {

/// A figure of 21 joints in a made-up motion, and its BVH as different programs would write it: the
/// same places of all joints in different words, axes and sizes.
inline constexpr size_t kFigureJoints = 21;

using FigureNames = std::array<const char*, kFigureJoints>;

/// MotionBuilder's words, as CMU's conversion and Mixamo have them.
inline constexpr FigureNames kFigureNames = {
    "Hips",      "Spine",       "Spine1",      "Neck",          "Head",        "LeftShoulder",
    "LeftArm",   "LeftForeArm", "LeftHand",    "RightShoulder", "RightArm",    "RightForeArm",
    "RightHand", "LeftUpLeg",   "LeftLeg",     "LeftFoot",      "LeftToeBase", "RightUpLeg",
    "RightLeg",  "RightFoot",   "RightToeBase"};

inline constexpr std::array<int, kFigureJoints> kFigureParents = {
    -1, 0, 1, 2, 3, 2, 5, 6, 7, 2, 9, 10, 11, 0, 13, 14, 15, 0, 17, 18, 19};

/// From the parent, T-pose facing +z, centimetres; an end site's for the last of each chain.
inline Eigen::Vector3d FigureOffset(size_t joint) {
  static const Eigen::Vector3d kOffsets[kFigureJoints] = {
      {0, 0, 0},   {0, 12, 0},  {0, 18, 0},  {0, 22, 0},  {0, 10, 0},  {3, 17, 0},  {14, 0, 0},
      {28, 0, 0},  {26, 0, 0},  {-3, 17, 0}, {-14, 0, 0}, {-28, 0, 0}, {-26, 0, 0}, {9, -4, 0},
      {0, -43, 0}, {0, -42, 0}, {0, -6, 13}, {-9, -4, 0}, {0, -43, 0}, {0, -42, 0}, {0, -6, 13}};
  return kOffsets[joint];
}

inline Eigen::Vector3d FigureEnd(size_t joint) {
  switch (joint) {
    case 4:
      return {0, 18, 0};
    case 8:
      return {16, 0, 0};
    case 12:
      return {-16, 0, 0};
    default:
      return {0, 0, 6};
  }
}

inline bool IsFigureEnd(size_t joint) {
  return std::find(kFigureParents.begin(), kFigureParents.end(), static_cast<int>(joint)) ==
         kFigureParents.end();
}

/// Local rotation from the T-pose: arms hang and swing, elbows and knees bend, the trunk turns.
inline Eigen::Quaterniond FigureTurn(size_t joint, size_t frame) {
  const double phase = 0.2 * static_cast<double>(frame);
  const auto turn = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const double swing = std::sin(phase);
  switch (joint) {
    case 0:
      return turn(20 * swing, y);
    case 1:
      return turn(4 + 3 * swing, x);
    case 2:
      return turn(8 * swing, y) * turn(3, x);
    case 4:
      return turn(15 * swing, y);
    case 6:
      return turn(-60, z) * turn(20 * swing, y);
    case 7:
      return turn(-30 - 20 * swing, y);
    case 10:
      return turn(60, z) * turn(20 * swing, y);
    case 11:
      return turn(30 - 20 * swing, y);
    case 13:
      return turn(-25 * swing, x);
    case 14:
      return turn(25 + 15 * swing, x);
    case 17:
      return turn(25 * swing, x);
    case 18:
      return turn(25 - 15 * swing, x);
    default:
      return Eigen::Quaterniond::Identity();
  }
}

inline Eigen::Vector3d FigureRoot(size_t frame) {
  return {1.0 * static_cast<double>(frame), 95.0, 2.0 * static_cast<double>(frame)};
}

/// Places of all joints, centimetres, y up.
inline std::vector<Eigen::Vector3d> FigurePlaces(size_t frame) {
  std::vector<Eigen::Vector3d> place;
  std::vector<Eigen::Quaterniond> turn;
  for (size_t j = 0; j < kFigureJoints; ++j) {
    if (j == 0) {
      place.push_back(FigureRoot(frame));
      turn.push_back(FigureTurn(0, frame));
      continue;
    }
    const auto parent = static_cast<size_t>(kFigureParents[j]);
    place.push_back(place[parent] + turn[parent] * FigureOffset(j));
    turn.push_back(turn[parent] * FigureTurn(j, frame));
  }
  return place;
}

/// How a program writes the figure.
struct FigureStyle {
  FigureNames names = kFigureNames;
  double units_per_cm = 1.0;
  size_t frames = 30;
  /// Every bone along its joint's own x axis: zero angles are no pose (Rokoko, Bandai-Namco).
  bool bones_along_x = false;
  /// Axes of all joints in the T-pose otherwise: the zero pose is a T-pose in these.
  Eigen::Quaterniond joint_axes = Eigen::Quaterniond::Identity();
  /// The file's axes of the motion, from y up.
  Eigen::Quaterniond file_from_world = Eigen::Quaterniond::Identity();
  std::string line_end = "\n";
};

namespace figure_detail {

/// Axes of a joint in the T-pose, so that its first child lies along x.
inline Eigen::Quaterniond AxesOf(size_t joint, const FigureStyle& style) {
  if (!style.bones_along_x) return style.joint_axes;
  Eigen::Vector3d along = FigureEnd(joint);
  for (size_t child = kFigureJoints; child-- > joint + 1;) {
    if (kFigureParents[child] == static_cast<int>(joint)) along = FigureOffset(child);
  }
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), along);
}

inline std::string Numbers(const Eigen::Vector3d& v) {
  std::string text;
  for (const double value : v) text += " " + std::to_string(value);
  return text;
}

/// Z, X, Y angles of a rotation, degrees.
inline Eigen::Vector3d Angles(const Eigen::Quaterniond& turn) {
  const Eigen::Matrix3d r = turn.toRotationMatrix();
  const double degrees = 180.0 / std::numbers::pi;
  const double x = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
  if (std::abs(r(2, 1)) > 1.0 - 1e-9) {  // gimbal lock: z and y are one turn
    return degrees * Eigen::Vector3d(std::atan2(r(1, 0), r(0, 0)), x, 0.0);
  }
  return degrees * Eigen::Vector3d(std::atan2(-r(0, 1), r(1, 1)), x, std::atan2(-r(2, 0), r(2, 2)));
}

inline void AppendJoint(size_t joint, const FigureStyle& style, std::string& text) {
  const bool root = kFigureParents[joint] < 0;
  const Eigen::Quaterniond parent = root
                                        ? Eigen::Quaterniond::Identity()
                                        : AxesOf(static_cast<size_t>(kFigureParents[joint]), style);
  text += (root ? "ROOT " : "JOINT ") + std::string(style.names[joint]) + "\n{\nOFFSET" +
          Numbers(style.units_per_cm * (parent.conjugate() * FigureOffset(joint))) +
          (root ? "\nCHANNELS 6 Xposition Yposition Zposition" : "\nCHANNELS 3") +
          " Zrotation Xrotation Yrotation\n";
  for (size_t child = joint + 1; child < kFigureJoints; ++child) {
    if (kFigureParents[child] == static_cast<int>(joint)) AppendJoint(child, style, text);
  }
  if (IsFigureEnd(joint)) {
    const Eigen::Vector3d end = AxesOf(joint, style).conjugate() * FigureEnd(joint);
    text += "End Site\n{\nOFFSET" + Numbers(style.units_per_cm * end) + "\n}\n";
  }
  text += "}\n";
}

}  // namespace figure_detail

inline std::string FigureHierarchy(const FigureStyle& style = {}) {
  std::string text;
  figure_detail::AppendJoint(0, style, text);
  return text;
}

/// The numbers of a frame, without a line end.
inline std::string FigureRow(size_t frame, const FigureStyle& style = {}) {
  using namespace figure_detail;
  std::string row =
      Numbers(style.units_per_cm * (style.file_from_world * FigureRoot(frame))).substr(1);
  for (size_t j = 0; j < kFigureJoints; ++j) {
    const Eigen::Quaterniond parent =
        j == 0 ? style.file_from_world
               : AxesOf(static_cast<size_t>(kFigureParents[j]), style).conjugate();
    row += Numbers(Angles(parent * FigureTurn(j, frame) * AxesOf(j, style)));
  }
  return row;
}

inline std::string FigureBvh(const FigureStyle& style = {}) {
  std::string text = "HIERARCHY\n" + FigureHierarchy(style) +
                     "MOTION\nFrames: " + std::to_string(style.frames) +
                     "\nFrame Time: 0.0333333\n";
  for (size_t f = 0; f < style.frames; ++f) text += FigureRow(f, style) + "\n";
  if (style.line_end == "\n") return text;
  std::string other;
  for (const char c : text) other += c == '\n' ? style.line_end : std::string(1, c);
  return other;
}

/// SDK joints that are joints of the figure: joint, the figure's number.
inline constexpr std::pair<int, size_t> kFigureSdkJoints[] = {
    {0, 0},   {2, 3},   {3, 4},   {4, 6},   {5, 7},   {6, 8},   {8, 10},  {9, 11}, {10, 12},
    {12, 13}, {13, 14}, {14, 15}, {15, 16}, {16, 17}, {17, 18}, {18, 19}, {19, 20}};

}  // namespace ossa::recon::test
