#include "tools/learning/person_source.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "depth/base/error.h"
#include "recon/body/parts.h"
#include "recon/skeleton.h"

namespace ossa::tools {
namespace {

using recon::Joint;

// Parts whose surface lies around a joint.
struct JointParts {
  Joint joint;
  std::vector<uint8_t> parts;
};

const std::vector<JointParts>& ListPartsByJoint() {
  static const std::vector<JointParts> table = {{Joint::kHipCenter, {20, 21, 22, 23}},
                                                {Joint::kSpine, {18, 19, 20, 21}},
                                                {Joint::kShoulderCenter, {5}},
                                                {Joint::kHead, {1, 2, 3, 4}},
                                                {Joint::kShoulderLeft, {6}},
                                                {Joint::kElbowLeft, {12}},
                                                {Joint::kWristLeft, {14}},
                                                {Joint::kHandLeft, {16}},
                                                {Joint::kShoulderRight, {7}},
                                                {Joint::kElbowRight, {13}},
                                                {Joint::kWristRight, {15}},
                                                {Joint::kHandRight, {17}},
                                                {Joint::kHipLeft, {20, 22}},
                                                {Joint::kKneeLeft, {26}},
                                                {Joint::kAnkleLeft, {28}},
                                                {Joint::kFootLeft, {30}},
                                                {Joint::kHipRight, {21, 23}},
                                                {Joint::kKneeRight, {27}},
                                                {Joint::kAnkleRight, {29}},
                                                {Joint::kFootRight, {31}}};
  return table;
}

// From right to left, shoulders and hips together.
Eigen::Vector3d ComputeLeft(const recon::Posture& joints_m) {
  return joints_m[Joint::kShoulderLeft] - joints_m[Joint::kShoulderRight] +
         (joints_m[Joint::kHipLeft] - joints_m[Joint::kHipRight]);
}

uint8_t FindSector(double angle_rad) {
  const double turns = angle_rad / (2.0 * std::numbers::pi);
  const auto sector = static_cast<int>(std::lround(turns * kFacingSectors)) + kFacingSectors;
  return static_cast<uint8_t>(sector % kFacingSectors);
}

}  // namespace

double YawRelativeToRay(const recon::Posture& joints_m) {
  Eigen::Vector3d left = ComputeLeft(joints_m);
  Eigen::Vector3d sight = joints_m[Joint::kHipCenter] + joints_m[Joint::kShoulderCenter];
  left.y() = 0;
  sight.y() = 0;
  // A person facing the camera at its centre has its left at -x and looks along -z.
  const Eigen::Vector3d facing = left.cross(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d towards = -sight;
  return std::atan2(towards.cross(facing).y(), towards.dot(facing));
}

uint8_t FacingSector(const recon::Posture& joints_m) {
  return FindSector(YawRelativeToRay(joints_m));
}

uint8_t HeadingSector(const recon::Posture& joints_m) {
  // Up is towards the camera; x grows to the image's left.
  const Eigen::Vector3d facing = ComputeLeft(joints_m).cross(-Eigen::Vector3d::UnitZ());
  return FindSector(std::atan2(-facing.x(), facing.y()));
}

forest::TrainingVocabulary BodyVocabulary() {
  forest::TrainingVocabulary vocabulary;
  for (const auto name : recon::kPartNames) vocabulary.class_names.emplace_back(name);
  for (int k = 0; k < kFacingSectors; ++k) {
    vocabulary.context_names.push_back(fmt::format("facing {}", 360 * k / kFacingSectors));
  }
  for (const JointParts& entry : ListPartsByJoint()) {
    forest::ProposalTarget target;
    target.name = recon::NameOf(entry.joint);
    target.classes = entry.parts;
    vocabulary.targets.push_back(std::move(target));
  }
  return vocabulary;
}

forest::TrainingImage PersonImage(const LabelledFrame& frame, const TruthBody& body) {
  forest::TrainingImage image;
  image.camera = frame.depth.camera;
  image.depth_mm.assign(frame.depth.depth_mm.size(), 0);
  image.label.assign(frame.depth.depth_mm.size(), 0);
  for (size_t i = 0; i < image.depth_mm.size(); ++i) {
    if (frame.users.data[i] != body.id || frame.parts.data[i] == 0) continue;
    image.depth_mm[i] = frame.depth.depth_mm[i];
    if (image.depth_mm[i] != 0) image.label[i] = frame.parts.data[i];
  }
  image.context = FacingSector(body.joints_m);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    image.target_m.push_back(body.joints_m.position_m[j].cast<float>());
    image.target_visible.push_back(body.visible[j] ? 1 : 0);
  }
  return image;
}

forest::TrainingImage Mirrored(const forest::TrainingImage& image) {
  forest::TrainingImage mirrored = image;
  const int width = image.camera.width;
  mirrored.camera.cx = width - 1 - image.camera.cx;
  for (int v = 0; v < image.camera.height; ++v) {
    for (int u = 0; u < width; ++u) {
      const auto from = static_cast<size_t>(v * width + u);
      const auto to = static_cast<size_t>(v * width + width - 1 - u);
      mirrored.depth_mm[to] = image.depth_mm[from];
      mirrored.label[to] = recon::kMirroredPart[image.label[from]];
    }
  }
  mirrored.context = static_cast<uint8_t>((kFacingSectors - image.context) % kFacingSectors);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const auto other = recon::kMirroredJoint[j];
    mirrored.target_m[j] = image.target_m[other].cwiseProduct(Eigen::Vector3f(-1, 1, 1));
    mirrored.target_visible[j] = image.target_visible[other];
  }
  return mirrored;
}

PersonSource::PersonSource(const std::vector<std::filesystem::path>& datasets, Range keep,
                           Extent extent)
    : extent_(extent) {
  for (const auto& folder : datasets) {
    readers_.emplace_back(folder);
    manifests_.push_back(readers_.back().manifest());
    const DatasetManifest& manifest = manifests_.back();
    for (int64_t i = 0; i < manifest.frames; ++i) {
      if (i % 100 >= keep.begin && i % 100 < keep.end) {
        places_.push_back({static_cast<uint32_t>(readers_.size() - 1), i});
      }
    }
    fingerprint_ +=
        fmt::format("{} frames seed {} by '{}'", manifest.frames, manifest.seed, manifest.command);
    if (!manifest.motion.empty()) {
      fingerprint_ += fmt::format(" of motion {} by ossa {}", manifest.motion, manifest.ossa);
    }
    fingerprint_ += "; ";
  }
  fingerprint_ += fmt::format("{} to {} of each 100", keep.begin, keep.end);
}

forest::TrainingImage PersonSource::Read(size_t index) const {
  const Place& place = places_.at(index);
  const DatasetReader& reader = readers_[place.dataset];
  const LabelledFrame crop = reader.Read(place.frame);
  const LabelledFrame frame =
      extent_ == Extent::kWholeImage ? Uncropped(crop, reader.manifest().camera) : crop;
  if (frame.bodies.empty()) {
    forest::TrainingImage none;
    none.camera = frame.depth.camera;
    none.depth_mm.assign(frame.depth.depth_mm.size(), 0);
    none.label.assign(frame.depth.depth_mm.size(), 0);
    none.target_m.assign(recon::kJointCount,
                         Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    none.target_visible.assign(recon::kJointCount, 0);
    return none;
  }
  const TruthBody& body = frame.bodies[static_cast<size_t>(place.frame) % frame.bodies.size()];
  forest::TrainingImage image = PersonImage(frame, body);
  if (reader.manifest().view == "ceiling") image.context = HeadingSector(body.joints_m);
  return image;
}

}  // namespace ossa::tools
