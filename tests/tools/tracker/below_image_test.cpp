// Joints outside the image are not placed in front of or behind the visible body.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "depth/image/depth_frame.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/sequence_poses.h"

namespace ossa::tracker {
namespace {

using recon::Joint;
using tools::LabelledFrame;

// A row that is below the elbows and above the wrists, as the border of a camera's image that looks
// over a desk. None where a hand is raised or the head is not in the image.
std::optional<int> FindRowAboveTheHands(const LabelledFrame& shot) {
  constexpr double kApart = 16.0, kLeastHeight = 100.0;  // pixels
  const auto row = [&](Joint joint) {
    return depth::Project(shot.depth.camera, shot.bodies[0].joints_m[joint]).y();
  };
  const double elbows = std::max(row(Joint::kElbowLeft), row(Joint::kElbowRight));
  const double wrists = std::min(row(Joint::kWristLeft), row(Joint::kWristRight));
  if (row(Joint::kHead) < 10.0 || elbows < kLeastHeight || wrists < elbows + kApart ||
      wrists > shot.depth.camera.height) {
    return std::nullopt;
  }
  return static_cast<int>((elbows + wrists) / 2.0);
}

depth::DepthFrame CutBelow(depth::DepthFrame frame, int height) {
  frame.camera.height = height;
  frame.depth_mm.resize(static_cast<size_t>(height) * static_cast<size_t>(frame.camera.width));
  return frame;
}

bool IsSeenFromBehind(const LabelledFrame& shot) {
  const auto& joints_m = shot.bodies[0].joints_m;
  return joints_m[Joint::kShoulderLeft].x() > joints_m[Joint::kShoulderRight].x();
}

struct Hands {
  int told = 0, below = 0;
  double share() const { return static_cast<double>(below) / told; }
};

void CountHands(const depth::DepthFrame& frame, Tracker& tracker, Hands* hands) {
  tracker.Reset();
  const BodyFrame seen = tracker.Track(frame);
  if (seen.bodies.size() != 1) return;
  for (const Joint hand : {Joint::kHandLeft, Joint::kHandRight}) {
    const auto& place_m = seen.bodies[0].joints[recon::Index(hand)].position_m;
    ++hands->told;
    hands->below += depth::Project(frame.camera, place_m).y() >= frame.camera.height ? 1 : 0;
  }
}

// Each image is a first frame, without state. From behind the forearms might as well be in front of
// the belly, so the requirement is stricter from the front.
TEST(BelowTheImage, HandsCutOffByTheBorderArePlacedBelowTheImage) {
  OSSA_NEEDS_MODEL();
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  constexpr int kImages = 500, kPostures = 9000;
  tools::FrameOptions options;
  options.width = 320;
  options.height = 240;
  options.view = tools::View::kAny;
  options.split = tools::Split::kTest;
  options.variation.random_arm_share = 0.0;
  options.seed = 9;
  const tools::FrameInputs inputs(tools::LoadFetchedBody(),
                                  tools::SequencePoses(AuthoredMotion(), kPostures, options.seed),
                                  options);
  tools::FrameMaker maker(inputs);
  Tracker tracker;
  Hands front, behind;
  for (int i = 0; i < kImages; ++i) {
    const LabelledFrame shot = maker.Make(i);
    const auto height = FindRowAboveTheHands(shot);
    if (!height) continue;
    CountHands(CutBelow(shot.depth, *height), tracker, IsSeenFromBehind(shot) ? &behind : &front);
  }
  ASSERT_GE(front.told, 10);
  ASSERT_GE(behind.told, 6);
  RecordProperty("front", std::to_string(front.below) + " of " + std::to_string(front.told));
  RecordProperty("behind", std::to_string(behind.below) + " of " + std::to_string(behind.told));
  EXPECT_GE(front.share(), 0.9) << front.below << " of " << front.told;
  EXPECT_GE(behind.share(), 0.6) << behind.below << " of " << behind.told;
}

}  // namespace
}  // namespace ossa::tracker
