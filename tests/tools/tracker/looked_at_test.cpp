// The tracker's joints after a close look: made-up networks, the shipped forest.
#include <gtest/gtest.h>

#include <cmath>

#include "recon/refine/bone_measure.h"
#include "recon/refine/close_look.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

// Whatever is seen, the head is higher up.
recon::CloseLook HeadHigher(float by_m) {
  recon::CloseLook look;
  recon::Glance& glance = look.glances.emplace_back();
  for (size_t k = 0; k < glance.size(); ++k) {
    recon::RectifiedNetwork& network = glance[k];
    network.input_mean = Eigen::VectorXf::Zero(recon::kLookInputs);
    network.input_scale = Eigen::VectorXf::Ones(recon::kLookInputs);
    network.layers = {{Eigen::MatrixXf::Zero(3, recon::kLookInputs), Eigen::VectorXf::Zero(3)}};
    if (recon::kLookJoints[k] == Joint::kHead) {
      network.layers[0].bias[1] = by_m / static_cast<float>(recon::CloseLook::kStep_m);
    }
  }
  return look;
}

// All bones longer by as many steps as the person's middle is metres farther than two, times five.
void MeasureByDistance(recon::CloseLook* look) {
  constexpr auto kBones = static_cast<Eigen::Index>(recon::kMeasuredBones.size());
  look->measured = 1;
  look->bones.input_mean = Eigen::VectorXf::Zero(recon::kBoneInputs);
  look->bones.input_scale = Eigen::VectorXf::Ones(recon::kBoneInputs);
  look->bones.layers = {{Eigen::MatrixXf::Zero(kBones, recon::kBoneInputs),
                         Eigen::VectorXf::Constant(kBones, -10.0F)}};
  look->bones.layers[0].weight.rightCols(1).setConstant(5.0F);
}

Body Tracked(const TrackerOptions& options) {
  Tracker tracker(options);
  BodyFrame result;
  for (int i = 0; i < 15; ++i) result = tracker.Track(Rendered({PersonAt(0, 2.5)}, i).frame);
  EXPECT_EQ(result.bodies.size(), 1U);
  return result.bodies.empty() ? Body{} : result.bodies[0];
}

TEST(LookedAt, JointsStandBesideTheRawOnesAndBestStartsFromThem) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const auto higher = [&](double by_m) {
    TrackerOptions options;
    options.look = folder / "head.ossalook";
    HeadHigher(static_cast<float>(by_m)).Save(options.look);
    return Tracked(options);
  };
  const Body there = higher(0.0), up = higher(0.06);
  ASSERT_TRUE(there.refined && up.refined);
  const auto moved_m = [](const recon::Posture& a, const recon::Posture& b) {
    return (b[Joint::kHead] - a[Joint::kHead]).y();
  };
  EXPECT_NEAR(moved_m(there.raw.posture, up.raw.posture), 0.0, 1e-9);
  EXPECT_NEAR(moved_m(there.raw.posture, *there.refined), 0.0, 1e-9);
  EXPECT_NEAR(moved_m(up.raw.posture, *up.refined), 0.06, 0.005);
  EXPECT_GT(moved_m(ToPosture(there), ToPosture(up)), 0.02);  // bones are kept, so not all of it
}

// Bones that the look judges half as long again are so in what best makes of the joints.
TEST(LookedAt, BestHasTheBonesThatTheLookJudges) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const auto shin_m = [&](float longer) {
    recon::CloseLook look = HeadHigher(0.0F);
    constexpr auto kBones = static_cast<Eigen::Index>(recon::kMeasuredBones.size());
    look.measured = 1;
    look.bones.input_mean = Eigen::VectorXf::Zero(recon::kBoneInputs);
    look.bones.input_scale = Eigen::VectorXf::Ones(recon::kBoneInputs);
    look.bones.layers = {{Eigen::MatrixXf::Zero(kBones, recon::kBoneInputs),
                          Eigen::VectorXf::Constant(kBones, std::log(longer) / 0.1F)}};
    TrackerOptions options;
    options.look = folder / "bones.ossalook";
    look.Save(options.look);
    return recon::MeasureBoneLengths(ToPosture(Tracked(options)))[recon::Index(Joint::kAnkleLeft)];
  };
  EXPECT_NEAR(shin_m(1.5F) / shin_m(1.0F), 1.5, 0.01);  // in a file, weights are halves
}

// Who walks away is measured longer and longer; the head rises by a step for each step of the spine
// that the look is told, which is the mean of the frames before.
TEST(LookedAt, TheLookIsToldOfTheBonesOfAllFramesBefore) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  recon::CloseLook look = HeadHigher(0.0F);
  MeasureByDistance(&look);
  const auto track = [&] {
    TrackerOptions options;
    options.look = folder / "told.ossalook";
    look.Save(options.look);
    std::vector<Body> frames;
    Tracker tracker(options);
    for (int i = 0; i < 20; ++i) {
      const auto now = tracker.Track(Rendered({PersonAt(0, 2.3 + 0.02 * i)}, i).frame);
      if (!now.bodies.empty() && now.bodies[0].refined) frames.push_back(now.bodies[0]);
    }
    return frames;
  };
  const std::vector<Body> without = track();
  recon::Glance& glance = look.told.emplace_back();
  for (size_t k = 0; k < glance.size(); ++k) {
    glance[k].input_mean = Eigen::VectorXf::Zero(recon::kToldInputs);
    glance[k].input_scale = Eigen::VectorXf::Ones(recon::kToldInputs);
    glance[k].layers = {{Eigen::MatrixXf::Zero(3, recon::kToldInputs), Eigen::VectorXf::Zero(3)}};
    const bool head = recon::kLookJoints[k] == Joint::kHead;
    if (head) glance[k].layers[0].weight(1, recon::kLookInputs) = 1.0F;
  }
  const std::vector<Body> with = track();
  ASSERT_EQ(with.size(), without.size());
  ASSERT_GT(with.size(), 10U);
  recon::JudgedBones before;
  for (size_t f = 0; f < with.size(); ++f) {
    const recon::BoneLengths judged_m = *with[f].refined_bones_m;
    const recon::BoneLengths told_m = f == 0 ? judged_m : before.mean_m;
    const double rise_m =
        ((*with[f].refined)[Joint::kHead] - (*without[f].refined)[Joint::kHead]).norm();
    EXPECT_NEAR(rise_m, recon::CloseLook::kStep_m * std::abs(recon::BoneOutputsOf(told_m)[0]),
                0.001)
        << f;
    before.Add(judged_m);
  }
  const double last = recon::BoneOutputsOf(*with.back().refined_bones_m)[0];
  EXPECT_GT(last - recon::BoneOutputsOf(before.mean_m)[0], 0.5);  // the mean is not the last one
}

TEST(LookedAt, OtherMethodsGoByTheRawJoints) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  TrackerOptions options = PlainOptions();
  const Body without = Tracked(options);
  EXPECT_FALSE(without.refined);  // nobody asked
  options.look = folder / "head.ossalook";
  HeadHigher(0.06F).Save(options.look);
  const Body with = Tracked(options);
  EXPECT_TRUE(with.refined);
  EXPECT_EQ(with.joints[Joint::kHead].position_m, without.joints[Joint::kHead].position_m);
}

TEST(LookedAt, NoLookMayBeAskedFor) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options;
  EXPECT_TRUE(Tracked(options).refined);
  options.look = "none";
  EXPECT_FALSE(Tracked(options).refined);
}

TEST(LookedAt, AForestOfOnesOwnIsNotLookedAtUnasked) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  TrackerOptions options;
  options.model = folder / "own.ossa";
  std::filesystem::copy_file(ModelOrNothing(), options.model);
  EXPECT_FALSE(Tracked(options).refined);
  options.look = folder / "missing.ossalook";
  EXPECT_THROW(Tracker{options}, InputError);
}

}  // namespace
}  // namespace ossa::tracker
