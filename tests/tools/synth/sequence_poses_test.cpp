#include "tools/synth/sequence_poses.h"

#include <gtest/gtest.h>

#include "recon/motion/mocap.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/frame_maker.h"

namespace ossa::tools {
namespace {

// Somebody in motion, for sixty frames.
class Sequence : public ::testing::TestWithParam<Occluders> {
 protected:
  void SetUp() override {
    if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  }
  static LabelledFrame RenderFrame(uint64_t seed, Occluders occluders, int64_t index) {
    static const std::vector<recon::MotionClip> clips = recon::LoadMocap({"authored"}, {});
    FrameOptions options;
    options.width = 160;
    options.height = 120;
    options.sequence = true;
    options.sensors = {depth::SensorKind::kNone};
    options.background = Background::kRoom;
    options.occluders = occluders;
    options.seed = seed;
    const FrameInputs inputs(LoadFetchedBody(), SequencePoses(clips, 60, seed), options);
    return FrameMaker(inputs).Make(index);
  }
};

TEST_P(Sequence, RoomAndStandingObjectsStayInPlace) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const LabelledFrame early = RenderFrame(seed, GetParam(), 0),
                        late = RenderFrame(seed, GetParam(), 40);
    int64_t compared = 0, moved = 0, of_objects = 0;
    for (size_t i = 0; i < early.parts.data.size(); ++i) {
      const bool stands = GetParam() == Occluders::kScene && early.parts.data[i] == 32;
      if (early.parts.data[i] != late.parts.data[i] || (early.parts.data[i] != 0 && !stands))
        continue;
      ++compared;
      of_objects += stands;
      moved += early.depth.depth_mm[i] != late.depth.depth_mm[i];
    }
    EXPECT_GT(compared, 160 * 120 / 2) << seed;
    EXPECT_EQ(moved, 0) << seed;
    if (GetParam() == Occluders::kScene) {
      EXPECT_GT(of_objects, 30) << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Occluders, Sequence,
                         ::testing::Values(Occluders::kNone, Occluders::kHeld, Occluders::kScene));

}  // namespace
}  // namespace ossa::tools
