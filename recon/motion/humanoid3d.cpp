#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "recon/motion/humanoid3d_internal.h"

namespace ossa::recon {
namespace {

constexpr size_t kNumbers = 44;  // a row of the format

/// Joints of the humanoid in the order of a frame's numbers. Names are those of the rig, so that
/// the known conventions find them. Offsets: Peng et al. 2018 (DeepMimic), humanoid3d; in
/// pybullet's humanoid.urdf they are four times as large.
struct Part {
  const char* name;
  int parent;
  double offset_m[3];
  int numbers;  // 4: quaternion w x y z; 1: angle about z; 0: fixed
};
constexpr std::array<Part, 15> kParts = {{
    {"Hips", -1, {0, 0, 0}, 4},
    {"Spine", 0, {0, 0.236151, 0}, 4},
    {"Head", 1, {0, 0.223894, 0}, 4},
    {"RightUpLeg", 0, {0, 0, 0.084887}, 4},
    {"RightLeg", 3, {0, -0.421546, 0}, 1},
    {"RightFoot", 4, {0, -0.40987, 0}, 4},
    {"RightArm", 1, {-0.02405, 0.2435, 0.18311}, 4},
    {"RightForeArm", 6, {0, -0.274788, 0}, 1},
    {"LeftUpLeg", 0, {0, 0, -0.084887}, 4},
    {"LeftLeg", 8, {0, -0.421546, 0}, 1},
    {"LeftFoot", 9, {0, -0.40987, 0}, 4},
    {"LeftArm", 1, {-0.02405, 0.2435, -0.18311}, 4},
    {"LeftForeArm", 11, {0, -0.274788, 0}, 1},
    {"RightHand", 7, {0, -0.258947, 0}, 0},
    {"LeftHand", 12, {0, -0.258947, 0}, 0},
}};

using Row = std::array<double, kNumbers>;

Row ReadRow(const nlohmann::json& row, size_t frame, const std::string& source) {
  const std::string where = source + ": Frames[" + std::to_string(frame) + "]: expected ";
  if (!row.is_array() || row.size() != kNumbers) {
    throw InputError(where + "44 numbers, found " +
                     (row.is_array() ? std::to_string(row.size()) : std::string(row.type_name())));
  }
  Row numbers{};
  for (size_t i = 0; i < kNumbers; ++i) {
    if (!row[i].is_number() || !(std::abs(row[i].get<double>()) < 1e6)) {
      throw InputError(where + "a number at [" + std::to_string(i) + "], found " +
                       std::string(row[i].type_name()));
    }
    numbers[i] = row[i].get<double>();
  }
  // Checks that all quaternions are rotations.
  size_t at = 4;
  for (const Part& part : kParts) {
    if (part.numbers == 4) {
      const Eigen::Vector4d q(numbers[at], numbers[at + 1], numbers[at + 2], numbers[at + 3]);
      // Published clips were blended component-wise: norms of 0.58 and 1.2 occur.
      constexpr double kShortest = 0.5, kLongest = 2.0;  // norms, ratios to 1; by hand
      if (!(q.norm() > kShortest && q.norm() < kLongest)) {
        throw InputError(where + "a unit quaternion at [" + std::to_string(at) +
                         "], found length " + std::to_string(q.norm()));
      }
    }
    at += static_cast<size_t>(part.numbers);
  }
  return numbers;
}

SourceFrame ToSourceFrame(const Row& row) {
  SourceFrame frame;
  size_t at = 4;
  for (const Part& part : kParts) {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    if (part.numbers == 4) {
      turn = Eigen::Quaterniond(row[at], row[at + 1], row[at + 2], row[at + 3]).normalized();
    } else if (part.numbers == 1) {
      turn = Eigen::AngleAxisd(row[at], Eigen::Vector3d::UnitZ());
    }
    at += static_cast<size_t>(part.numbers);
    const Eigen::Vector3d offset(part.offset_m[0], part.offset_m[1], part.offset_m[2]);
    if (part.parent < 0) {
      frame.position.emplace_back(row[1], row[2], row[3]);
      frame.rotation.push_back(turn);
    } else {
      const auto parent = static_cast<size_t>(part.parent);
      frame.position.push_back(frame.position[parent] + frame.rotation[parent] * offset);
      frame.rotation.push_back(frame.rotation[parent] * turn);
    }
  }
  return frame;
}

}  // namespace

SourceMotion ParseHumanoid3d(const std::string& text, const std::string& source) {
  if (JsonNesting().IsTooDeep(text)) {
    throw InputError(source + ": expected JSON that nests at most 32 deep");
  }
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("Frames") || !json["Frames"].is_array() ||
      json["Frames"].empty()) {
    throw InputError(source +
                     ": byte 0: expected JSON {\"Loop\", \"Frames\": [[44 numbers], ...]}");
  }
  const auto rows = std::make_shared<std::vector<Row>>();
  for (const auto& row : json["Frames"]) rows->push_back(ReadRow(row, rows->size(), source));
  SourceMotion motion;
  motion.source = source;
  motion.frame_s = rows->front()[0];  // the same in all frames but the last, where it is 0
  if (rows->size() == 1) motion.frame_s = 1.0 / 30.0;
  if (motion.frame_s < 1e-4 || motion.frame_s > 60.0) {
    throw InputError(source + ": Frames[0]: expected a frame time between 0.0001 and 60 s, found " +
                     std::to_string(motion.frame_s));
  }
  motion.frame_count = rows->size();
  for (const Part& part : kParts) {
    motion.joints.push_back(
        {part.name, part.parent, {part.offset_m[0], part.offset_m[1], part.offset_m[2]}, {}});
  }
  motion.frame = [rows](size_t frame) { return ToSourceFrame((*rows)[frame]); };
  return motion;
}

}  // namespace ossa::recon
