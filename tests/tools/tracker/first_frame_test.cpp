// Who is found in a single image, before anything is known of them or of the room.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "recon/motion/mocap.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/synth/clothed_actor.h"
#include "tools/synth/dataset.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/sequence_poses.h"

namespace ossa::tracker {
namespace {

using recon::Joint;
using tools::LabelledFrame;

// Somebody holds a board up before belly and hips: head and shoulders show above it, the legs
// below. None where they are not seen whole, or are not upright.
std::optional<depth::DepthFrame> WithABoard(const LabelledFrame& shot) {
  constexpr double kBefore_m = 0.3, kHalfWidth_m = 0.45;
  const auto& joints_m = shot.bodies[0].joints_m;
  const depth::Camera& camera = shot.depth.camera;
  const auto at = [&](Joint joint) { return depth::Project(camera, joints_m[joint]); };
  const double foot = std::max(at(Joint::kFootLeft).y(), at(Joint::kFootRight).y());
  const Eigen::Vector3d& spine_m = joints_m[Joint::kSpine];
  const bool upright = joints_m[Joint::kHead].y() > joints_m[Joint::kHipCenter].y() + 0.5;
  if (!upright || at(Joint::kHead).y() < 20.0 || foot > camera.height - 5) return std::nullopt;
  depth::DepthFrame frame = shot.depth;
  const double half_px = kHalfWidth_m * camera.fx / (spine_m.z() - kBefore_m);
  const int top = static_cast<int>(0.5 * (at(Joint::kSpine).y() + at(Joint::kShoulderCenter).y()));
  const int bottom =
      static_cast<int>(0.5 * (at(Joint::kHipCenter).y() +
                              std::min(at(Joint::kKneeLeft).y(), at(Joint::kKneeRight).y())));
  const int left = std::max(0, static_cast<int>(at(Joint::kSpine).x() - half_px));
  const int right = std::min(camera.width, static_cast<int>(at(Joint::kSpine).x() + half_px));
  for (int v = top; v < bottom; ++v) {
    for (int u = left; u < right; ++u) {
      frame.depth_mm[static_cast<size_t>(v) * static_cast<size_t>(camera.width) +
                     static_cast<size_t>(u)] =
          static_cast<uint16_t>(1000.0 * (spine_m.z() - kBefore_m));
    }
  }
  return frame;
}

// One person in each image, another body every eight.
class FirstFrame : public testing::Test {
 protected:
  void SetUp() override {
    OSSA_NEEDS_MODEL();
    if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
    options_.width = 320;
    options_.height = 240;
    options_.split = tools::Split::kTest;
    options_.variation.random_arm_share = 0.0;
    options_.seed = 3;
  }
  // How many bodies are found in each image; none where `change` leaves the image out.
  template <typename Change>
  std::vector<size_t> CountBodies(int images, const Change& change) const {
    constexpr int kPostures = 3000;
    const tools::FrameStudio studio(
        tools::LoadFetchedBody(),
        tools::SequencePoses(recon::LoadMocap({"authored"}), kPostures, options_.seed), options_);
    tools::FrameMaker maker(studio);
    Tracker tracker;
    std::vector<size_t> bodies;
    for (int i = 0; i < images; ++i) {
      const std::optional<depth::DepthFrame> frame =
          change(tools::Uncropped(maker.Make(i), tools::MakeCamera(options_)));
      if (!frame) continue;
      tracker.Reset();
      bodies.push_back(tracker.Track(*frame).bodies.size());
    }
    return bodies;
  }
  tools::FrameOptions options_;
};

// The board is flat and as deep as they are: many are not found yet, but three in four are (59 of
// 76; 52 while a half that looked like nobody was not tried with the other).
TEST_F(FirstFrame, WhoHoldsABoardBeforeThemselvesIsOnePerson) {
  const auto bodies = CountBodies(160, WithABoard);
  ASSERT_GE(bodies.size(), 20U);
  const auto one = std::ranges::count(bodies, 1U);
  EXPECT_GE(one, 0.72 * static_cast<double>(bodies.size())) << one << " of " << bodies.size();
}

// Coats on stands have a hook for a head, and sleeves: five of 120 images had a body too
// many while as much was asked of a second one as of the first.
TEST_F(FirstFrame, CoatsBesideSomebodyAreNobody) {
  options_.background = tools::Background::kLivedIn;
  options_.width = 640;
  options_.height = 480;
  const auto bodies =
      CountBodies(120, [](const LabelledFrame& shot) { return std::optional(shot.depth); });
  const auto more = std::ranges::count_if(bodies, [](size_t count) { return count > 1; });
  EXPECT_LE(more, 3) << more << " of " << bodies.size();
}

}  // namespace
}  // namespace ossa::tracker
