#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"
#include "recon/body/standard_body.h"
#include "recon/refine/bone_measure.h"
#include "recon/refine/close_look.h"

namespace ossa::recon::test {

inline constexpr int kWidth = 160, kHeight = 120;
inline constexpr double kWall_m = 2.0;
inline constexpr int kCentre = (kLookGrid / 2) * (kLookGrid + 1);  // of the finer grid

// Somebody two metres away whose surface is a wall that fills the image, all joints 5 cm within.
struct Scene {
  depth::DepthFrame frame;
  std::vector<uint8_t> is_person;
  LookInput input;

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

// One glance that moves nothing.
inline CloseLook Silent() {
  CloseLook look;
  look.people = 7;
  for (RectifiedNetwork& network : look.glances.emplace_back()) {
    network.input_mean = Eigen::VectorXf::Zero(kLookInputs);
    network.input_scale = Eigen::VectorXf::Ones(kLookInputs);
    network.layers = {{Eigen::MatrixXf::Zero(2, kLookInputs), Eigen::VectorXf::Zero(2)},
                      {Eigen::MatrixXf::Zero(3, 2), Eigen::VectorXf::Zero(3)}};
  }
  return look;
}

// A measure that says of every person that all bones are standard.
inline RectifiedNetwork StandardBones() {
  constexpr auto kBones = static_cast<Eigen::Index>(kMeasuredBones.size());
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Zero(kBoneInputs);
  network.input_scale = Eigen::VectorXf::Ones(kBoneInputs);
  network.layers = {{Eigen::MatrixXf::Zero(kBones, kBoneInputs), Eigen::VectorXf::Zero(kBones)}};
  return network;
}

// A look that says nothing but of the bones, all standard, and then once more, told of them.
inline CloseLook SilentAndTold() {
  CloseLook look = Silent();
  look.bones = StandardBones();
  look.measured = 3;
  for (RectifiedNetwork& network : look.told.emplace_back()) {
    network.input_mean = Eigen::VectorXf::Zero(kToldInputs);
    network.input_scale = Eigen::VectorXf::Ones(kToldInputs);
    network.layers = {{Eigen::MatrixXf::Zero(3, kToldInputs), Eigen::VectorXf::Zero(3)}};
  }
  return look;
}

inline size_t NetworkOf(Joint joint) {
  return static_cast<size_t>(std::find(kLookJoints.begin(), kLookJoints.end(), joint) -
                             kLookJoints.begin());
}

}  // namespace ossa::recon::test
