#include "tools/synth/pose_bank.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "recon/body/standard_body.h"
#include "recon/motion/mocap.h"

namespace ossa::tools {
namespace {

const std::vector<recon::MotionClip>& Clips() {
  static const auto clips = recon::LoadMocap({"authored"}, {});
  return clips;
}

TEST(PoseBank, NaturalPosesHaveTheirFrequencyInTheMotion) {
  const auto& clips = Clips();
  size_t frames = 0;
  for (const auto& clip : clips) frames += clip.frames.size();
  EXPECT_EQ(MakePoseBank(clips, MakeBankOptions(Poses::kNatural)).size(), frames);
  EXPECT_LT(MakePoseBank(clips, MakeBankOptions(Poses::kSpread)).size(), frames / 2);
}

TEST(PoseBank, VariesNaturalPosesLittle) {
  const auto bank = MakePoseBank(Clips(), MakeBankOptions(Poses::kNatural));
  const auto farthest_m = [&](Poses poses) {
    PoseVariation variation = MakeVariation(poses);
    variation.mirror_share = 0.0;
    double farthest = 0.0;
    for (uint64_t i = 0; i < 200; ++i) {
      Random random(i, 0);
      const recon::RigPose& pose = bank[(i * 37) % bank.size()];
      const auto wrist = [](const recon::RigPose& of) {
        return recon::StandardPosture(of)[recon::Joint::kWristLeft];
      };
      const Eigen::Vector3d moved_m = wrist(Varied(pose, variation, random)) - wrist(pose);
      farthest = std::max(farthest, moved_m.norm());
    }
    return farthest;
  };
  EXPECT_LT(farthest_m(Poses::kNatural), 0.08);
  EXPECT_GT(farthest_m(Poses::kSpread), 0.2);
}

TEST(PoseBank, ParsesItsNames) {
  EXPECT_EQ(PosesFromName("natural"), Poses::kNatural);
  EXPECT_EQ(PosesFromName("spread"), Poses::kSpread);
  EXPECT_FALSE(PosesFromName("Natural"));
}

}  // namespace
}  // namespace ossa::tools
