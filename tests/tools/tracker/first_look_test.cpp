// Who is found in a single image: by the shipped forest, and by a pose network.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "recon/refine/pose_network.h"
#include "tests/recon/refine/pose_networks.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/people/detect_people.h"

namespace ossa::tracker {
namespace {

// A network that expects the same error of every joint, whatever it sees: 0.3 m times exp(`log`).
std::shared_ptr<const recon::PoseNetwork> NetworkOfError(float log) {
  auto layers = recon::test::SilentLayers();
  auto& votes = layers.back().bias;
  for (Eigen::Index joint = 0; joint < votes.size() / 5; ++joint) votes[5 * joint + 4] = log;
  return std::make_shared<const recon::PoseNetwork>(std::move(layers), 1, "test");
}

BodyFrame FirstLook(std::shared_ptr<const recon::PoseNetwork> network,
                    const depth::DepthFrame& frame) {
  TrackerOptions options;
  options.mount = Mount::kLevel;
  options.models = ModelSet::Shipped(options.method);
  options.models->pose_network = std::move(network);
  return Tracker(options).Track(frame);
}

TEST(FirstLook, WhomThePoseNetworkDoesNotKnowIsNobodyYet) {
  OSSA_NEEDS_MODEL();
  const depth::DepthFrame frame = Rendered({PersonAt(0, 2.5)}).frame;
  EXPECT_EQ(FirstLook(nullptr, frame).bodies.size(), 1U);
  EXPECT_EQ(FirstLook(NetworkOfError(-2.0F), frame).bodies.size(), 1U);
  const BodyFrame unknown = FirstLook(NetworkOfError(1.0F), frame);
  EXPECT_TRUE(unknown.bodies.empty());
  EXPECT_TRUE(std::ranges::any_of(unknown.decisions.candidates, [](const auto& decision) {
    return decision.rule == people::Rule::kFirstLook && decision.area_m2 > 0.3;
  }));
}

// The network reads the same joints in either half.
TEST(FirstLook, WhatAPoleBeforeTheMiddleLeavesOfAPersonIsOneBody) {
  OSSA_NEEDS_MODEL();
  const auto network = ModelSet::Shipped(TrackerOptions{}.method).pose_network;
  for (const double half_m : {0.02, 0.04}) {  // of the pole's width
    depth::DepthFrame frame = Rendered({PersonAt(0, 2.5)}).frame;
    for (size_t i = 0; i < frame.depth_mm.size(); ++i) {
      const int u = static_cast<int>(i) % frame.camera.width;
      const double x_m = 1.8 * (u - frame.camera.cx) / frame.camera.fx;
      if (std::abs(x_m) < half_m) frame.depth_mm[i] = 1800;
    }
    const BodyFrame seen = FirstLook(network, frame);
    ASSERT_EQ(seen.bodies.size(), 1U) << half_m;
    EXPECT_LT(std::abs(seen.bodies[0].position_m.x()), 0.05) << half_m;
  }
}

}  // namespace
}  // namespace ossa::tracker
