// Labelled frames under every option: labels lie on the bodies they name, and a frame is its
// seed's.
#include "tools/synth/frame_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "recon/motion/mocap.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/shard_internal.h"

namespace ossa::tools {
namespace {

using recon::Joint;

struct Case {
  std::string name;
  std::function<void(FrameOptions&)> set;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class Frames : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  }
  static const std::vector<recon::RigPose>& Bank() {
    static const std::vector<recon::RigPose> bank = [] {
      return MakePoseBank(recon::LoadMocap({"authored-floor"}));
    }();
    return bank;
  }
  static LabelledFrame RenderFrame(const Case& c, int64_t index, uint64_t seed = 3) {
    FrameOptions options;
    options.width = 160;
    options.height = 120;
    options.view = View::kFront;
    options.seed = seed;
    c.set(options);
    static const recon::BodyModel body = LoadFetchedBody();
    const FrameInputs inputs(body, Bank(), options);
    return FrameMaker(inputs).Make(index);
  }
};

TEST_P(Frames, HighBitsOfTheSeedCount) {
  const auto shoot = [](uint64_t seed) { return RenderFrame(GetParam(), 0, seed).depth.depth_mm; };
  EXPECT_NE(shoot(3), shoot(3 + (uint64_t{1} << 61U)));
}

TEST_P(Frames, LabelsLieOnTheirBodies) {
  int64_t hands = 0, far = 0, labelled = 0;
  for (int64_t index = 0; index < 12; ++index) {
    const LabelledFrame frame = RenderFrame(GetParam(), index);
    const depth::Camera& camera = frame.depth.camera;
    ASSERT_EQ(frame.parts.data.size(), frame.depth.depth_mm.size());
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const uint8_t part = frame.parts.at(u, v);
        if (part == 0) continue;
        ++labelled;
        const auto mm = frame.depth.depth_mm[static_cast<size_t>(v * camera.width + u)];
        ASSERT_GT(mm, 0) << "a label without a reading";
        ASSERT_GE(frame.users.at(u, v), 1);
        if (part != 16 && part != 17) continue;
        ++hands;
        const auto& body = frame.bodies[frame.users.at(u, v) - 1u];
        const Joint hand = part == 16 ? Joint::kHandLeft : Joint::kHandRight;
        far += (depth::BackProject(camera, u, v, mm) - body.joints_m[hand]).norm() > 0.25 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(labelled, 1000);
  EXPECT_GT(hands, 20);
  // Flying pixels carry the label of the nearer surface, and hands here are few pixels wide.
  EXPECT_LE(far, hands / 5) << "of " << hands;
}

TEST_P(Frames, DependOnSeedAndNumberAlone) {
  const LabelledFrame once = RenderFrame(GetParam(), 5), again = RenderFrame(GetParam(), 5);
  EXPECT_EQ(once.depth.depth_mm, again.depth.depth_mm);
  EXPECT_EQ(once.parts.data, again.parts.data);
  EXPECT_NE(once.depth.depth_mm, RenderFrame(GetParam(), 5, 4).depth.depth_mm);
}

INSTANTIATE_TEST_SUITE_P(
    Options, Frames,
    ::testing::Values(
        Case{"kinect_v2", [](FrameOptions& o) { o.sensors = {depth::SensorKind::kKinectV2}; }},
        Case{"azure", [](FrameOptions& o) { o.sensors = {depth::SensorKind::kAzure}; }},
        Case{"d4xx", [](FrameOptions& o) { o.sensors = {depth::SensorKind::kD4xx}; }},
        Case{"xtion", [](FrameOptions& o) { o.sensors = {depth::SensorKind::kXtion}; }},
        Case{"held_up", [](FrameOptions& o) { o.occluders = Occluders::kHeldUp; }},
        Case{"desk", [](FrameOptions& o) { o.occluders = Occluders::kDesk; }},
        Case{"clothes",
             [](FrameOptions& o) {
               o.hanging_clothes = o.ends = true;
               o.people = 2;
             }},
        Case{"lived_in", [](FrameOptions& o) { o.background = Background::kLivedIn; }},
        Case{"postures", [](FrameOptions& o) { o.variation = MakeVariation(Poses::kAny); }},
        Case{"ceiling", [](FrameOptions& o) { o.view = View::kCeiling; }},
        Case{"cameras", [](FrameOptions& o) { o.cameras = Cameras::kAny; }},
        Case{"shrunk",
             [](FrameOptions& o) {
               o.shrink = 2.4;
               o.fov_deg = 60;
             }}),
    [](const auto& info) { return info.param.name; });

TEST_F(Frames, FramesWithOwnCamerasKeepTheUncroppedSize) {
  const Case any{"any", [](FrameOptions& o) { o.cameras = Cameras::kAny; }};
  for (int64_t index = 0; index < 4; ++index) {
    const LabelledFrame frame = RenderFrame(any, index);
    ASSERT_TRUE(frame.whole);
    Shard shard{.first_index = index, .offsets = {0}, .blobs = PackFrame(frame), .file = "shard"};
    shard.offsets.push_back(shard.blobs.size());
    const LabelledFrame back = Uncropped(UnpackFrame(shard, index), depth::KinectV1Camera(64, 48));
    EXPECT_EQ(back.depth.camera.width, frame.whole->width);
    EXPECT_NEAR(back.depth.camera.cx, frame.whole->cx, 1e-9);
  }
}

}  // namespace
}  // namespace ossa::tools
