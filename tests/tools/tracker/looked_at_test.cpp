// The tracker's joints after a close look: made-up networks, the shipped forest.
#include <gtest/gtest.h>

#include <cmath>

#include "recon/look/bone_measure.h"
#include "recon/look/close_look.h"
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

Body Tracked(const TrackerOptions& options) {
  Tracker tracker(options);
  BodyFrame result;
  for (int i = 0; i < 15; ++i) result = tracker.Push(Rendered({PersonAt(0, 2.5)}, i).frame);
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
  ASSERT_TRUE(there.looked && up.looked);
  const auto moved_m = [](const recon::Posture& a, const recon::Posture& b) {
    return (b[Joint::kHead] - a[Joint::kHead]).y();
  };
  EXPECT_NEAR(moved_m(there.raw.posture, up.raw.posture), 0.0, 1e-9);
  EXPECT_NEAR(moved_m(there.raw.posture, *there.looked), 0.0, 1e-9);
  EXPECT_NEAR(moved_m(up.raw.posture, *up.looked), 0.06, 0.005);
  EXPECT_GT(moved_m(there.smoothed, up.smoothed), 0.02);  // bones are kept, so not all of it
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
    return recon::BoneLengthsOf(Tracked(options).smoothed)[recon::Index(Joint::kAnkleLeft)];
  };
  EXPECT_NEAR(shin_m(1.5F) / shin_m(1.0F), 1.5, 0.01);  // in a file, weights are halves
}

TEST(LookedAt, OtherMethodsGoByTheRawJoints) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  TrackerOptions options = PlainOptions();
  const Body without = Tracked(options);
  EXPECT_FALSE(without.looked);  // nobody asked
  options.look = folder / "head.ossalook";
  HeadHigher(0.06F).Save(options.look);
  const Body with = Tracked(options);
  EXPECT_TRUE(with.looked);
  EXPECT_EQ(with.smoothed[Joint::kHead], without.smoothed[Joint::kHead]);
}

TEST(LookedAt, NoLookMayBeAskedFor) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options;
  EXPECT_TRUE(Tracked(options).looked);
  options.look = "none";
  EXPECT_FALSE(Tracked(options).looked);
}

TEST(LookedAt, AForestOfOnesOwnIsNotLookedAtUnasked) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  TrackerOptions options;
  options.model = folder / "own.ossa";
  std::filesystem::copy_file(ModelOrNothing(), options.model);
  EXPECT_FALSE(Tracked(options).looked);
  options.look = folder / "missing.ossalook";
  EXPECT_THROW(Tracker{options}, InputError);
}

}  // namespace
}  // namespace ossa::tracker
