#include "recon/refine/close_look.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "recon/refine/bone_measure.h"

namespace ossa::recon {
namespace {

// The mean of the proposals, those of little confidence less.
Eigen::Vector3d MiddleOf(const LookInput& input) {
  constexpr double kLeastWeight = 0.05;
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  double whole = 0.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    const double weight = std::max(kLeastWeight, input.confidence[j]);
    sum_m += weight * input.proposed.position_m[j];
    whole += weight;
  }
  return sum_m / whole;
}

bool CanBeLookedAt(const LookInput& input) {
  const depth::DepthFrame* frame = input.depth;
  if (frame == nullptr || frame->camera.width <= 0 || frame->camera.height <= 0 ||
      input.is_person.size() != frame->depth_mm.size() ||
      frame->depth_mm.size() !=
          static_cast<size_t>(frame->camera.width) * static_cast<size_t>(frame->camera.height)) {
    return false;
  }
  constexpr double kFarthest_m = 100.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!(input.proposed.position_m[j].norm() < kFarthest_m)) return false;
    if (!(input.moved.position_m[j].norm() < kFarthest_m)) return false;
    if (!(input.confidence[j] >= 0.0 && input.confidence[j] <= 1.0)) return false;
  }
  return true;
}

// Of a body at all, however small or large.
bool AreBones(const BoneLengths& lengths_m) {
  constexpr double kShortest_m = 1e-3, kLongest_m = 10.0;
  return std::all_of(lengths_m.begin() + 1, lengths_m.end(), [](double length_m) {
    return length_m >= kShortest_m && length_m <= kLongest_m;
  });
}

}  // namespace

LookInput LookInput::MovedTo(const Posture& joints_m) const {
  LookInput out = *this;
  for (size_t j = 0; j < kJointCount; ++j) {
    out.moved.position_m[j] += joints_m.position_m[j] - proposed.position_m[j];
  }
  out.proposed = joints_m;
  return out;
}

std::optional<ProposedPerson> ProposedPerson::Of(const LookInput& input) {
  if (!CanBeLookedAt(input)) return std::nullopt;
  ProposedPerson out;
  out.middle_m = MiddleOf(input);
  const Eigen::Vector3d z = out.middle_m.normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitY().cross(z);
  constexpr double kLeast = 1e-3;  // right above, below or behind the sensor nobody is seen
  if (!(out.middle_m.z() > 0.0 && level.norm() > kLeast)) return std::nullopt;
  const Eigen::Vector3d x = level.normalized();
  out.frame_from_camera << x.transpose(), z.cross(x).transpose(), z.transpose();
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

std::optional<LookDescription> LookDescription::Of(const LookInput& input,
                                                   const JointSet& looked_at) {
  const auto person = ProposedPerson::Of(input);
  if (!person) return std::nullopt;
  LookDescription out{*person};
  const SurfaceSampler sampler(*input.depth, input.is_person, out.frame_from_camera);
  for (size_t j = 0; j < kJointCount; ++j) {
    if (looked_at[j]) out.samples[j] = sampler.Around(input.proposed.position_m[j]);
  }
  return out;
}

LookDescription LookDescription::Mirrored() const {
  LookDescription out{ProposedPerson::Mirrored()};
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = kMirroredJoint[j];
    for (size_t row = 0; row < kLookSamples; row += kLookGrid) {
      std::reverse_copy(samples[j].begin() + static_cast<std::ptrdiff_t>(row),
                        samples[j].begin() + static_cast<std::ptrdiff_t>(row + kLookGrid),
                        out.samples[other].begin() + static_cast<std::ptrdiff_t>(row));
    }
  }
  return out;
}

Eigen::VectorXf NumbersOf(const LookDescription& description, Joint joint) {
  Eigen::VectorXf numbers(kLookInputs);
  float* next = numbers.data();
  const auto& samples = description.samples[joint];
  for (const LookSample& sample : samples) {
    *next++ = 1e-3F * sample.surface() * static_cast<float>(sample.behind_mm());
  }
  for (const LookSample& sample : samples) *next++ = sample.beside();
  for (const LookSample& sample : samples) *next++ = sample.hidden();
  for (const Eigen::Vector3d& place_m : description.place.position_m) {
    const Eigen::Vector3f from_m = (place_m - description.place[joint]).cast<float>();
    next = std::copy(from_m.begin(), from_m.end(), next);
  }
  for (const Eigen::Vector3d& moved_m : description.moved.position_m) {
    const Eigen::Vector3f by_m = moved_m.cast<float>();
    next = std::copy(by_m.begin(), by_m.end(), next);
  }
  for (const double confidence : description.confidence) *next++ = static_cast<float>(confidence);
  for (const bool seen : description.seen) *next++ = seen ? 1.0F : 0.0F;
  const Eigen::Vector3f middle_m = description.middle_m.cast<float>();
  std::copy(middle_m.begin(), middle_m.end(), next);
  return numbers;
}

Looker::Looker(const CloseLook& look) {
  std::vector<const RectifiedNetwork*> networks;
  const auto add = [&networks](const std::vector<Glance>& glances) {
    for (const Glance& glance : glances) {
      for (const RectifiedNetwork& network : glance) networks.push_back(&network);
    }
  };
  add(look.glances);
  before_bones_ = networks.size();
  if (!look.bones.empty()) {
    networks.push_back(&look.bones);
    add(look.told);
  }
  networks_ = NetworkRunner::Of(networks);
}

// Each joint that is looked at moved by what its network says of it; of a pair both at once, the
// right one mirrored.
Posture Looker::Moved(Networks of_joints, const LookInput& input, const LookDescription& seen,
                      const JointSet& looked_at) {
  Posture joints_m = input.proposed;
  const LookDescription mirrored = seen.Mirrored();
  const Eigen::Vector3d mirror(-1.0, 1.0, 1.0);
  const Eigen::Matrix3d camera_from_frame = seen.frame_from_camera.transpose();
  for (size_t k = 0; k < kLookJoints.size(); ++k) {
    const Joint joint = kLookJoints[k];
    const auto index = Index(joint);
    const auto other = kMirroredJoint[index];
    const bool one = looked_at[index], two = other != index && looked_at[other];
    if (!one && !two) continue;
    Eigen::MatrixXf numbers(input.bones_m ? kToldInputs : kLookInputs, one && two ? 2 : 1);
    numbers.col(0).head(kLookInputs) = NumbersOf(one ? seen : mirrored, joint);
    if (one && two) numbers.col(1).head(kLookInputs) = NumbersOf(mirrored, joint);
    if (input.bones_m) {
      numbers.bottomRows(kToldInputs - kLookInputs).colwise() = BoneOutputsOf(*input.bones_m);
    }
    const Eigen::MatrixXd offsets_m = CloseLook::kStep_m * of_joints[k].Run(numbers).cast<double>();
    for (Eigen::Index column = 0; column < offsets_m.cols(); ++column) {
      const bool is_mirrored = !one || column == 1;
      Eigen::Vector3d offset_m = offsets_m.col(column);
      offset_m *= std::min(1.0, CloseLook::kFarthest_m / std::max(offset_m.norm(), 1e-9));
      if (is_mirrored) offset_m = mirror.cwiseProduct(offset_m);
      joints_m.position_m[is_mirrored ? other : index] += camera_from_frame * offset_m;
    }
  }
  return joints_m;
}

// As far as there is something to see.
LookInput Looker::Glanced(Networks networks, LookInput input) {
  JointSet looked_at = kAllJoints;
  for (size_t first = 0; first < networks.size(); first += kLookJoints.size()) {
    const auto seen = LookDescription::Of(input, looked_at);
    if (!seen) break;
    const Networks of_joints = networks.subspan(first, kLookJoints.size());
    const Posture next_m = Moved(of_joints, input, *seen, looked_at);
    for (size_t j = 0; j < kJointCount; ++j) {
      const double moved_m = (next_m.position_m[j] - input.proposed.position_m[j]).norm();
      if (moved_m < CloseLook::kAtRest_m) looked_at[j] = false;
    }
    input = input.MovedTo(next_m);
  }
  return input;
}

std::optional<Looked> Looker::Look(const LookInput& input) const {
  if (!ProposedPerson::Of(input)) return std::nullopt;
  const Networks all = networks_;
  LookInput now = input;
  now.bones_m.reset();
  now = Glanced(all.first(before_bones_), std::move(now));
  Looked out{now.proposed, std::nullopt};
  const auto person = ProposedPerson::Of(now);
  if (all.size() == before_bones_ || !person) return out;
  out.bones_m = MeasuredBones(all[before_bones_], *person);
  now.bones_m = input.bones_m && AreBones(*input.bones_m) ? input.bones_m : out.bones_m;
  out.joints_m = Glanced(all.subspan(before_bones_ + 1), std::move(now)).proposed;
  return out;
}

}  // namespace ossa::recon
