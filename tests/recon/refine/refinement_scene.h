#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"
#include "recon/body/standard_body.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/support/perceptrons.h"

namespace ossa::recon::test {

inline constexpr int kWidth = 160, kHeight = 120;
inline constexpr double kWall_m = 2.0;
inline constexpr int kCentre = (kSurfaceGrid / 2) * (kSurfaceGrid + 1);  // of the finer grid

// A person two metres away whose surface is a wall that fills the image, with all joints 5 cm
// inside.
struct Scene {
  depth::DepthFrame frame;
  std::vector<uint8_t> is_person;
  RefinementInput input;

  Scene() {
    frame.camera = depth::KinectV1Camera(kWidth, kHeight);
    frame.depth_mm.assign(kWidth * kHeight, static_cast<uint16_t>(1000 * kWall_m));
    is_person.assign(frame.depth_mm.size(), 1);
    const Posture standing = StandardPosture(RigPose{});
    for (size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d& p_m = standing.position_m[j];
      input.proposed.position_m[j] = {0.5 * p_m.x(), 0.5 * p_m.y(), kWall_m + 0.05};
    }
    input.confidence.fill(0.8);
    input.seen.fill(true);
    input.depth = &frame;
    input.is_person = is_person;
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
};

// One stage that moves nothing.
inline RefinementCascade Silent() {
  RefinementCascade cascade;
  cascade.people = 7;
  cascade.stages.emplace_back().fill(ossa::test::SilentPerceptron({kStageFeatures, 2, 3}));
  return cascade;
}

// A network that always estimates standard bones.
inline Perceptron StandardBones() {
  return ossa::test::SilentPerceptron({kBoneFeatures, kEstimatedBones.size()});
}

// The same with bones, all standard, and a bone-conditioned stage that moves nothing either.
inline RefinementCascade SilentAndBoneConditioned() {
  RefinementCascade cascade = Silent();
  cascade.bones = StandardBones();
  cascade.measured = 3;
  cascade.bone_conditioned.emplace_back().fill(
      ossa::test::SilentPerceptron({kBoneConditionedFeatures, 3}));
  return cascade;
}

inline size_t NetworkOf(Joint joint) {
  return static_cast<size_t>(std::find(kStageJoints.begin(), kStageJoints.end(), joint) -
                             kStageJoints.begin());
}

}  // namespace ossa::recon::test
