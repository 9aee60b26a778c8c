// The tracker's joints after the refinement cascade: made-up networks, the shipped forest.
#include <gtest/gtest.h>

#include <cmath>

#include "depth/base/checksummed_container.h"
#include "recon/bone_lengths.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/pose_network.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/recon/refine/pose_networks.h"
#include "tests/support/perceptrons.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

// Whatever is seen, the head is higher up.
recon::RefinementCascade HeadHigher(float by_m) {
  recon::RefinementCascade look;
  recon::RefinementStage& stage = look.stages.emplace_back();
  for (size_t k = 0; k < stage.size(); ++k) {
    Perceptron& network = stage[k];
    network = test::SilentPerceptron({recon::kStageFeatures, 3});
    if (recon::kStageJoints[k] == Joint::kHead) {
      network.layers[0].bias[1] =
          by_m / static_cast<float>(recon::RefinementCascade::kOffsets.step_m);
    }
  }
  return look;
}

// All bones longer by as many steps as the person's middle is metres farther than two, times five.
void MeasureByDistance(recon::RefinementCascade* look) {
  look->measured = 1;
  look->bones = test::SilentPerceptron({recon::kBoneFeatures, recon::kEstimatedBones.size()});
  look->bones.layers[0].bias.setConstant(-10.0F);
  look->bones.layers[0].weight.bottomRows(1).setConstant(5.0F);
}

// By the cascade alone, without the body's surface.
Body Tracked(TrackerOptions options) {
  options.fit.reset();
  Tracker tracker(options);
  BodyFrame result;
  for (int i = 0; i < 15; ++i) result = tracker.Track(Rendered({PersonAt(0, 2.5)}, i).frame);
  EXPECT_EQ(result.bodies.size(), 1U);
  return result.bodies.empty() ? Body{} : result.bodies[0];
}

TEST(RefinedJoints, AreReturnedBesideTheRawOnesAndUsedByBest) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const auto higher = [&](double by_m) {
    ModelFiles files;
    files.refinement = folder / "head.ossarefine";
    HeadHigher(static_cast<float>(by_m)).Save(files.refinement);
    return Tracked(OptionsWith(files));
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

// Bones that the cascade estimates half as long again are so in what best makes of the joints.
TEST(RefinedJoints, BestHasTheBonesThatTheCascadeEstimates) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const auto shin_m = [&](float longer) {
    recon::RefinementCascade look = HeadHigher(0.0F);
    look.measured = 1;
    look.bones = test::SilentPerceptron({recon::kBoneFeatures, recon::kEstimatedBones.size()});
    look.bones.layers[0].bias.setConstant(std::log(longer) / 0.1F);
    ModelFiles files;
    files.refinement = folder / "bones.ossarefine";
    look.Save(files.refinement);
    return recon::MeasureBoneLengths(
        ToPosture(Tracked(OptionsWith(files))))[recon::Index(Joint::kAnkleLeft)];
  };
  EXPECT_NEAR(shin_m(1.5F) / shin_m(1.0F), 1.5, 0.01);  // in a file, weights are halves
}

// The frames of a person who walks away, with refined joints by this cascade.
std::vector<Body> TrackWalkAway(const recon::RefinementCascade& cascade) {
  const test::TemporaryFolder folder;
  ModelFiles files;
  files.refinement = folder / "bones.ossarefine";
  cascade.Save(files.refinement);
  std::vector<Body> frames;
  Tracker tracker(OptionsWith(files));
  for (int i = 0; i < 20; ++i) {
    const auto now = tracker.Track(Rendered({PersonAt(0, 2.3 + 0.02 * i)}, i).frame);
    if (!now.bodies.empty() && now.bodies[0].refined) frames.push_back(now.bodies[0]);
  }
  return frames;
}

// A bone-conditioned stage that raises the head by the encoded length of the first bone.
void RaiseHeadByBones(recon::RefinementCascade* cascade) {
  recon::RefinementStage& stage = cascade->bone_conditioned.emplace_back();
  for (size_t k = 0; k < stage.size(); ++k) {
    stage[k] = test::SilentPerceptron({recon::kBoneConditionedFeatures, 3});
    const bool head = recon::kStageJoints[k] == Joint::kHead;
    if (head) stage[k].layers[0].weight(recon::kStageFeatures, 1) = 1.0F;
  }
}

// The estimated bones of a person who walks away grow; the head rises by the length that the stage
// reads, which is the mean of the frames before.
TEST(RefinedJoints, BoneConditionedStagesReadTheMeanOfEarlierFrames) {
  OSSA_NEEDS_MODEL();
  recon::RefinementCascade look = HeadHigher(0.0F);
  MeasureByDistance(&look);
  const std::vector<Body> without = TrackWalkAway(look);
  RaiseHeadByBones(&look);
  const std::vector<Body> with = TrackWalkAway(look);
  ASSERT_EQ(with.size(), without.size());
  ASSERT_GT(with.size(), 10U);
  recon::BoneLengthEstimator before(recon::BoneLengthOptions::ForNetworkEstimates());
  for (size_t f = 0; f < with.size(); ++f) {
    const recon::BoneLengths judged_m = *with[f].refined_bones_m;
    const recon::BoneLengths told_m = f == 0 ? judged_m : before.lengths_m();
    const double rise_m =
        ((*with[f].refined)[Joint::kHead] - (*without[f].refined)[Joint::kHead]).norm();
    EXPECT_NEAR(
        rise_m,
        recon::RefinementCascade::kOffsets.step_m * std::abs(recon::EncodeBoneLengths(told_m)[0]),
        0.001)
        << f;
    before.Add(judged_m);
  }
  const double last = recon::EncodeBoneLengths(*with.back().refined_bones_m)[0];
  EXPECT_GT(last - recon::EncodeBoneLengths(before.lengths_m())[0],
            0.5);  // the mean is not the last one
}

TEST(RefinedJoints, OtherMethodsUseTheRawJoints) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const Body without = Tracked(OptionsWith({}, "none"));
  EXPECT_FALSE(without.refined);  // nobody asked
  ModelFiles files;
  files.refinement = folder / "head.ossarefine";
  HeadHigher(0.06F).Save(files.refinement);
  const Body with = Tracked(OptionsWith(files, "none"));
  EXPECT_TRUE(with.refined);
  EXPECT_EQ(with.joints[Joint::kHead].position_m, without.joints[Joint::kHead].position_m);
}

// Joints below the image, which the forest does not place, are where the network has them alone:
// here in the middle of the person, not on the way there from the camera.
TEST(RefinedJoints, JointsMissingFromTheForestComeFromThePoseNetwork) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  ModelFiles files;
  files.refinement = "none";
  files.pose_network = folder / "silent.ossanet";
  auto layers = recon::test::SilentLayers();
  layers.back().bias.setConstant(-2.0F);  // the errors' logarithms: it is sure of the person
  for (Eigen::Index v = 0; v < layers.back().bias.size(); ++v) {
    if (v % 5 != 4) layers.back().bias[v] = 0.0F;
  }
  recon::PoseNetwork(std::move(layers), 1, "test").Save(files.pose_network);
  int unplaced = 0;
  for (const int rows : {100, 120, 140, 160}) {  // of the image, from its top
    depth::DepthFrame frame = Rendered({PersonAt(0.0, 2.0)}).frame;
    frame.camera.height = rows;
    frame.depth_mm.resize(static_cast<size_t>(rows * frame.camera.width));
    for (const Body& body : Tracker(OptionsWith(files)).Track(frame).bodies) {
      ASSERT_TRUE(body.refined);
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        if (body.raw.state[j] != recon::TrackingState::kNotTracked) continue;
        ++unplaced;
        EXPECT_LT((body.refined->position_m[j] - body.position_m).norm(), 0.2) << rows << ' ' << j;
      }
    }
  }
  EXPECT_GT(unplaced, 0);
}

TEST(RefinedJoints, CanBeSwitchedOff) {
  OSSA_NEEDS_MODEL();
  EXPECT_TRUE(Tracked({}).refined);
  ModelFiles files;
  files.refinement = "none";
  EXPECT_FALSE(Tracked(OptionsWith(files)).refined);
}

TEST(RefinedJoints, CustomForestIsRefinedOnRequestOnly) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  ModelFiles files;
  files.forest = folder / "own.ossa";
  std::filesystem::copy_file(ModelOrNothing(), files.forest);
  EXPECT_FALSE(Tracked(OptionsWith(files)).refined);
  files.refinement = folder / "missing.ossarefine";
  EXPECT_THROW(ModelSet::Load(files), InputError);
}

// A cascade in a file, learned at the joints of the forest of that checksum; 0: not known.
std::string SaveLearnedAt(const test::TemporaryFolder& folder, uint64_t forest, bool from_above) {
  recon::RefinementCascade look = HeadHigher(0.0F);
  look.forest_checksum = forest;
  look.from_above = from_above;
  const std::string file = folder / "a.ossarefine";
  look.Save(file);
  return file;
}

// At the level forest's joints, at those of the one for ceilings.
class RefinementOfAForest : public testing::TestWithParam<bool> {};

TEST_P(RefinementOfAForest, WarnsInOneLineIfUsedWithAnotherForest) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  ModelFiles files;
  const std::string forest = ShippedFile(GetParam() ? "body_ceiling.ossa" : "body.ossa").string();
  const uint64_t own = ReadContainerChecksum(forest);
  for (const uint64_t fits : {own, uint64_t{0}}) {
    files.refinement = SaveLearnedAt(folder, fits, GetParam());
    EXPECT_TRUE(ModelSet::Load(files).warnings.empty());
  }
  files.refinement = SaveLearnedAt(folder, own + 1, GetParam());
  EXPECT_EQ(ModelSet::Load(files).warnings,
            std::vector<std::string>{files.refinement +
                                     ": learned at the joints of another forest than " + forest +
                                     ": 'ossa refine' trains one at those"});
}

INSTANTIATE_TEST_SUITE_P(Mounts, RefinementOfAForest, testing::Bool(),
                         [](const auto& mount) { return mount.param ? "Ceiling" : "Level"; });

TEST(RefinedJoints, ForestIsRecognisedByContentAndShippedModelsGiveNoWarning) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  ModelFiles files;
  files.forest = folder / "own.ossa";
  std::filesystem::copy_file(ModelOrNothing(), files.forest);
  files.refinement = SaveLearnedAt(folder, ReadContainerChecksum(ModelOrNothing()), false);
  EXPECT_TRUE(ModelSet::Load(files).warnings.empty());
  EXPECT_TRUE(ModelSet::Shipped().warnings.empty());
  files = {};
  files.forest = ShippedFile("body_ceiling.ossa");
  files.refinement = ShippedFile("body_ceiling.ossarefine");
  EXPECT_TRUE(ModelSet::Load(files).warnings.empty());
}

}  // namespace
}  // namespace ossa::tracker
