#include "recon/refine/refinement_cascade.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "recon/refine/bone_estimation.h"

namespace ossa::recon {
namespace {

// Constants: bounds, by hand.

bool CanBeRefined(const RefinementInput& input) {
  const depth::DepthFrame* frame = input.depth;
  if (frame == nullptr || frame->camera.width <= 0 || frame->camera.height <= 0 ||
      input.is_person.size() != frame->pixel_count() ||
      frame->pixel_count() !=
          static_cast<size_t>(frame->camera.width) * static_cast<size_t>(frame->camera.height)) {
    return false;
  }
  if (input.floor && !input.floor->allFinite()) return false;
  constexpr double kFarthest_m = 100.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!(input.proposed.position_m[j].norm() < kFarthest_m)) return false;
    if (!(input.moved.position_m[j].norm() < kFarthest_m)) return false;
    if (!(input.confidence[j] >= 0.0 && input.confidence[j] <= 1.0)) return false;
  }
  return true;
}

// Direction from the left side of the body to the right one.
Eigen::Vector3d ComputeAcross(const Posture& posture) {
  return posture[Joint::kShoulderRight] - posture[Joint::kShoulderLeft] +
         (posture[Joint::kHipRight] - posture[Joint::kHipLeft]);
}

// The frame rotated about its z axis so that x points along `across`; unchanged if that is the ray.
ViewFrame TurnedAlong(const ViewFrame& frame, const Eigen::Vector3d& across_m) {
  constexpr double kLeast_m = 0.05;  // shorter is noise
  const Eigen::Vector3d z = frame.frame_from_camera.row(2);
  const Eigen::Vector3d level = across_m - z.dot(across_m) * z;
  if (level.norm() < kLeast_m) return frame;
  const Eigen::Vector3d x = level.normalized();
  ViewFrame turned = frame;
  turned.frame_from_camera << x.transpose(), z.cross(x).transpose(), z.transpose();
  return turned;
}

// Whether these can be the bones of a body of any size.
bool AreBones(const BoneLengths& lengths_m) {
  constexpr double kShortest_m = 1e-3, kLongest_m = 10.0;
  return std::all_of(lengths_m.begin() + 1, lengths_m.end(), [](double length_m) {
    return length_m >= kShortest_m && length_m <= kLongest_m;
  });
}

}  // namespace

RefinementInput RefinementInput::MovedTo(const Posture& joints_m) const {
  RefinementInput out = *this;
  for (size_t j = 0; j < kJointCount; ++j) {
    out.moved.position_m[j] += joints_m.position_m[j] - proposed.position_m[j];
  }
  out.proposed = joints_m;
  return out;
}

std::optional<ProposedPerson> ProposedPerson::Locate(const RefinementInput& input) {
  constexpr double kLeastConfidence = 0.05;  // by hand; part of every cascade; confidence
  if (!CanBeRefined(input)) return std::nullopt;
  const auto frame =
      MakeViewFrame(ComputeMiddle(input.proposed.position_m, input.confidence, kLeastConfidence));
  if (!frame) return std::nullopt;
  ProposedPerson out;
  static_cast<ViewFrame&>(out) = *frame;
  out.where_m = out.middle_m;
  if (input.floor) {
    static_cast<ViewFrame&>(out) = TurnedAlong(*frame, ComputeAcross(input.proposed));
    const Eigen::Vector3d up = input.floor->head<3>();
    const double height_m = up.dot(out.middle_m) + (*input.floor)[3];
    out.where_m = out.frame_from_camera * (-height_m * up);
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d& joint_m = input.proposed.position_m[j];
    out.place.position_m[j] = out.frame_from_camera * (joint_m - out.middle_m);
    out.moved.position_m[j] = out.frame_from_camera * input.moved.position_m[j];
  }
  out.confidence = input.confidence;
  out.seen = input.seen;
  return out;
}

ProposedPerson ProposedPerson::Mirrored() const {
  const Eigen::Vector3d mirror(-1.0, 1.0, 1.0);
  ProposedPerson out = *this;
  out.middle_m = mirror.cwiseProduct(middle_m);
  out.where_m = mirror.cwiseProduct(where_m);
  out.frame_from_camera = mirror.asDiagonal() * frame_from_camera * mirror.asDiagonal();
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = kMirroredJoint[j];
    out.place.position_m[other] = mirror.cwiseProduct(place.position_m[j]);
    out.moved.position_m[other] = mirror.cwiseProduct(moved.position_m[j]);
    out.confidence[other] = confidence[j];
    out.seen[other] = seen[j];
  }
  return out;
}

std::optional<SampledPerson> SampledPerson::Sample(const RefinementInput& input,
                                                   const JointSet& chosen) {
  const auto person = ProposedPerson::Locate(input);
  if (!person) return std::nullopt;
  SampledPerson out{*person};
  const SurfaceSampler sampler(*input.depth, input.is_person, out.frame_from_camera);
  for (size_t j = 0; j < kJointCount; ++j) {
    if (chosen[j]) out.samples[j] = sampler.Around(input.proposed.position_m[j]);
  }
  return out;
}

SampledPerson SampledPerson::Mirrored() const {
  SampledPerson out{ProposedPerson::Mirrored()};
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = kMirroredJoint[j];
    for (size_t row = 0; row < kSurfaceSamples; row += kSurfaceGrid) {
      std::reverse_copy(samples[j].begin() + static_cast<std::ptrdiff_t>(row),
                        samples[j].begin() + static_cast<std::ptrdiff_t>(row + kSurfaceGrid),
                        out.samples[other].begin() + static_cast<std::ptrdiff_t>(row));
    }
  }
  return out;
}

Eigen::RowVectorXf ComputeStageFeatures(const SampledPerson& person, Joint joint) {
  Eigen::RowVectorXf numbers(kStageFeatures);
  float* next = numbers.data();
  const auto& samples = person.samples[joint];
  for (const SurfaceSample& sample : samples) {
    *next++ = 1e-3F * sample.surface() * static_cast<float>(sample.behind_mm());
  }
  for (const SurfaceSample& sample : samples) *next++ = sample.beside();
  for (const SurfaceSample& sample : samples) *next++ = sample.hidden();
  for (const Eigen::Vector3d& place_m : person.place.position_m) {
    const Eigen::Vector3f from_m = (place_m - person.place[joint]).cast<float>();
    next = std::copy(from_m.begin(), from_m.end(), next);
  }
  for (const Eigen::Vector3d& moved_m : person.moved.position_m) {
    const Eigen::Vector3f by_m = moved_m.cast<float>();
    next = std::copy(by_m.begin(), by_m.end(), next);
  }
  for (const double confidence : person.confidence) *next++ = static_cast<float>(confidence);
  for (const bool seen : person.seen) *next++ = seen ? 1.0F : 0.0F;
  const Eigen::Vector3f where_m = person.where_m.cast<float>();
  std::copy(where_m.begin(), where_m.end(), next);
  return numbers;
}

JointRefiner::JointRefiner(const RefinementCascade& cascade)
    : from_above_(cascade.from_above), forest_checksum_(cascade.forest_checksum) {
  PerceptronPacker packer(0);
  const auto add = [&packer](const std::vector<RefinementStage>& stages) {
    for (const RefinementStage& stage : stages) {
      for (const Perceptron& network : stage) packer.Add(network);
    }
  };
  add(cascade.stages);
  before_bones_ = cascade.stages.size() * kStageJoints.size();
  if (!cascade.bones.empty()) {
    packer.Add(cascade.bones);
    add(cascade.bone_conditioned);
  }
  networks_ = packer.Take();
}

// Moves each chosen joint by its network's offset; both of a pair at once, the right one mirrored.
Posture JointRefiner::RunStage(Networks of_joints, const RefinementInput& input,
                               const SampledPerson& seen, const JointSet& chosen) {
  Posture joints_m = input.proposed;
  const SampledPerson mirrored = seen.Mirrored();
  for (size_t k = 0; k < kStageJoints.size(); ++k) {
    const Joint joint = kStageJoints[k];
    const auto index = Index(joint);
    const auto other = kMirroredJoint[index];
    std::vector<RegressedPoints> rows;
    if (chosen[index]) rows.push_back({std::span(&index, 1), false});
    if (other != index && chosen[other]) rows.push_back({std::span(&other, 1), true});
    if (rows.empty()) continue;
    RowMatrix features(static_cast<Eigen::Index>(rows.size()),
                       input.bones_m ? kBoneConditionedFeatures : kStageFeatures);
    for (size_t r = 0; r < rows.size(); ++r) {
      features.row(static_cast<Eigen::Index>(r)).head(kStageFeatures) =
          ComputeStageFeatures(rows[r].mirrored ? mirrored : seen, joint);
    }
    if (input.bones_m) {
      features.rightCols(kBoneConditionedFeatures - kStageFeatures).rowwise() =
          EncodeBoneLengths(*input.bones_m);
    }
    Regress(of_joints[k], features, rows, seen, RefinementCascade::kOffsets, joints_m.position_m);
  }
  return joints_m;
}

// Stops when there is nothing to sample.
RefinementInput JointRefiner::RunStages(Networks networks, RefinementInput input) {
  JointSet chosen = kAllJoints;
  for (size_t first = 0; first < networks.size(); first += kStageJoints.size()) {
    const auto seen = SampledPerson::Sample(input, chosen);
    if (!seen) break;
    const Networks of_joints = networks.subspan(first, kStageJoints.size());
    const Posture next_m = RunStage(of_joints, input, *seen, chosen);
    for (size_t j = 0; j < kJointCount; ++j) {
      const double moved_m = (next_m.position_m[j] - input.proposed.position_m[j]).norm();
      if (moved_m < RefinementCascade::kAtRest_m) chosen[j] = false;
    }
    input = input.MovedTo(next_m);
  }
  return input;
}

std::optional<RefinedPerson> JointRefiner::Refine(const RefinementInput& input) const {
  if (from_above_ && !input.floor) return std::nullopt;
  const Networks all = networks_;
  RefinementInput now = input;
  if (!from_above_) now.floor.reset();
  if (!ProposedPerson::Locate(now)) return std::nullopt;
  now.bones_m.reset();
  now = RunStages(all.first(before_bones_), std::move(now));
  RefinedPerson out{now.proposed, std::nullopt};
  const auto person = ProposedPerson::Locate(now);
  if (all.size() == before_bones_ || !person) return out;
  out.bones_m = EstimateBones(all[before_bones_], *person);
  now.bones_m = input.bones_m && AreBones(*input.bones_m) ? input.bones_m : out.bones_m;
  out.joints_m = RunStages(all.subspan(before_bones_ + 1), std::move(now)).proposed;
  return out;
}

}  // namespace ossa::recon
