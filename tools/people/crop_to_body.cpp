// Removal of furniture that touches a detected person.
#include "recon/body/standard_body.h"
#include "tools/people/classify_candidates.h"

namespace ossa::people {
namespace {

// Bones between the joint proposals, from the trunk outwards as far as they are connected: for each
// joint the best proposal at a plausible bone length from its parent.
std::vector<Bone> ConnectBones(const JointTargets& targets, const ForestEvidence& evidence,
                               double max_bone_ratio) {
  using recon::Joint;
  const recon::BoneLengths average_m =
      recon::MeasureBoneLengths(recon::StandardPosture(recon::RigPose{}));
  const auto modes_of = [&](size_t j) -> const std::vector<forest::Proposal>& {
    return evidence.proposals.at(static_cast<size_t>(targets[j]));
  };
  recon::JointArray<const forest::Proposal*> reached{};
  std::vector<Bone> bones;
  const auto reach = [&](size_t from, size_t to, size_t bone) {
    const Eigen::Vector3d& from_m = reached[from]->position_m;
    for (const forest::Proposal& mode : modes_of(to)) {
      if ((mode.position_m - from_m).norm() > max_bone_ratio * average_m[bone]) continue;
      reached[to] = &mode;
      bones.push_back({from_m.cast<float>(), mode.position_m.cast<float>()});
      return;
    }
  };
  // The shoulders' middle is the surest; from there down to the hips, and parents before children.
  constexpr auto kCentre = recon::Index(Joint::kShoulderCenter);
  constexpr auto kSpine = recon::Index(Joint::kSpine);
  if (modes_of(kCentre).empty()) return bones;
  reached[kCentre] = &modes_of(kCentre).front();
  reach(kCentre, kSpine, kCentre);
  if (reached[kSpine]) reach(kSpine, 0, kSpine);
  for (size_t j = kCentre + 1; j < recon::kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    if (reached[parent]) reach(parent, j, j);
  }
  return bones;
}

// Whether the region extends beyond the bounding box of the bones by more than `reach_m`.
bool ReachesBeyond(const std::vector<Bone>& bones, const Region& region, float reach_m) {
  Eigen::Vector3f low_m = region.high_m, high_m = region.low_m;
  for (const Bone& bone : bones) {
    low_m = low_m.cwiseMin(bone.from_m).cwiseMin(bone.to_m);
    high_m = high_m.cwiseMax(bone.from_m).cwiseMax(bone.to_m);
  }
  return ((low_m - region.low_m).array() > reach_m).any() ||
         ((region.high_m - high_m).array() > reach_m).any();
}

}  // namespace

void CropToBody(const JointTargets& targets, const DepthFrame& frame, const Scene& scene,
                const ClassificationOptions& options, Detection& detection) {
  constexpr size_t kAllBones = recon::kJointCount - 1;
  const auto bones = ConnectBones(targets, detection.evidence, options.max_bone_ratio);
  if (bones.size() < options.min_crop_bones) return;
  const Region& region = detection.candidate.region;
  const bool large = region.area_m2 >= options.crop_area_m2;
  const bool whole = bones.size() == kAllBones && ReachesBeyond(bones, region, options.crop_far_m);
  if (!large && !whole) return;
  const size_t whole_pixels = detection.candidate.pixels.size();
  CropToBones(scene, frame, bones, large ? options.crop_m : options.crop_far_m,
              options.min_cropped_cells, detection.candidate);
  if (detection.candidate.pixels.size() != whole_pixels) detection.pose.reset();
}

}  // namespace ossa::people
