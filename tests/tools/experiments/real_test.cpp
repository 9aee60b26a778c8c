#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/image/depth_png.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"
#include "tools/experiments/real/real_agreement_internal.h"
#include "tools/experiments/real/real_evaluation_internal.h"
#include "tools/experiments/real/real_held_internal.h"
#include "tools/experiments/real/real_holes_internal.h"

namespace ossa::tools {
namespace {

using recon::Joint;

// A folder laid out as SHARED: one set of two flat images with marks beside them.
class SharedWithMarks {
 public:
  SharedWithMarks() {
    std::filesystem::create_directories(set());
    const std::vector<uint16_t> wall_mm(64 * 48, 2000);
    for (const char* name : {"a.png", "b.png"}) {
      depth::WriteDepthPng(set() / name, {wall_mm.data(), 64, 48, 64});
    }
  }
  void Mark(const std::string& lines) const { std::ofstream(set() / "marks.txt") << lines; }
  std::filesystem::path set() const { return folder_ / "real/depth_frames/mine"; }
  std::filesystem::path path() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
};

TEST(RealSets, MarksFileBesideImagesDefinesASet) {
  const SharedWithMarks shared;
  shared.Mark("# by eye\na.png Head 30 10\nb.png Head 31 11\nb.png HandLeft 50 20\n");
  const auto sets = ReadRealSets(shared.path(), 0);
  ASSERT_EQ(sets.size(), 1u);
  EXPECT_EQ(sets[0].name, "mine");
  EXPECT_EQ(sets[0].joint_names, (std::vector<std::string>{"Head", "HandLeft"}));
  ASSERT_EQ(sets[0].stills.size(), 2u);
  EXPECT_EQ(*sets[0].stills[1].truth[0].pixel, Eigen::Vector2d(31, 11));
  EXPECT_FALSE(sets[0].stills[0].truth[1].pixel.has_value());
}

TEST(RealSets, DamagedMarkIsRefusedByItsLine) {
  const SharedWithMarks shared;
  shared.Mark("a.png Head 30 10\na.png Nose 30 10\n");
  test::ExpectRefused([&] { ReadRealSets(shared.path(), 0); }, "marks.txt: line 2");
}

TEST(RealSets, FoldersWithoutMarksAreRecordingsWithoutTruth) {
  const SharedWithMarks shared;
  EXPECT_TRUE(ReadRealSets(shared.path(), 0).empty());
  const auto videos = ReadRealVideos(shared.path(), 1);
  ASSERT_EQ(videos.size(), 1u);
  EXPECT_TRUE(videos[0].stills);
  EXPECT_EQ(videos[0].frames.size(), 1u);
}

TEST(RealSets, FoldersWithoutMarksMayStateTheirCamera) {
  const SharedWithMarks shared;
  const depth::Camera before = ReadRealVideos(shared.path(), 1)[0].frames[0].camera;
  depth::Camera stated = before;
  stated.fx = stated.fy = 2.0 * before.fx;
  depth::WriteCameraJson(shared.set() / "camera.json", stated);
  EXPECT_EQ(ReadRealVideos(shared.path(), 1)[0].frames[0].camera.fx, 2.0 * before.fx);
}

// Four stills of a set of one joint, whose errors along x are given; the last finds nothing.
struct OneJoint {
  RealSet set{.name = "one"};
  std::vector<StillResult> results;

  explicit OneJoint(const std::vector<double>& errors_m) {
    set.joints = {Joint::kHead};
    set.joint_names = {"Head"};
    for (const double x : errors_m) {
      StillResult result;
      result.has_truth = {true};
      result.errors[RealStage::kRaw] = {Eigen::Vector3d(x, 0, 0)};
      results.push_back(result);
    }
    results.push_back({.bodies = 0, .errors = {}, .has_truth = {true}});
  }
};

TEST(RealScore, MissingJointCountsAsWrongAndInNoMean) {
  const OneJoint one({0.02, 0.04, 0.12});
  const StageScore score = ScoreStage(one.set, one.results, RealStage::kRaw, false, {true});
  EXPECT_EQ(score.joints, 4);
  EXPECT_EQ(score.found, 3);
  EXPECT_NEAR(score.mean_cm.value(), 6.0, 1e-9);
  EXPECT_NEAR(score.within_5cm, 0.5, 1e-9);
  EXPECT_NEAR(score.within_10cm, 0.5, 1e-9);
  EXPECT_NEAR(score.per_joint_10cm.at("Head"), 0.5, 1e-9);
}

TEST(RealScore, HasNoMeanForJointsThatAreNeverFound) {
  const OneJoint one({});
  EXPECT_EQ(ScoreStage(one.set, one.results, RealStage::kRaw, false, {true}).mean_cm, std::nullopt);
}

// Offsets of even stills come from the odd ones: 10 cm for stills 0, 2, 4 and 0 for the others.
TEST(RealScore, OffsetsAreEstimatedOnTheOtherHalf) {
  const OneJoint one({0.11, 0.10, 0.01, 0.10, 0.01, 0.10});
  const StageScore score = ScoreStage(one.set, one.results, RealStage::kRaw, true, {true});
  EXPECT_NEAR(score.mean_cm.value(), 100 * (0.01 + 0.09 + 0.09 + 3 * 0.09) / 6, 1e-9);
}

TEST(RealScore, OffsetsOfSmallSetsAreEstimatedOnAllStills) {
  OneJoint one({0.11, 0.10, 0.09});
  one.set.offsets_from_other_half = false;
  const StageScore score = ScoreStage(one.set, one.results, RealStage::kRaw, true, {true});
  EXPECT_NEAR(score.mean_cm.value(), 2.0 / 3.0, 1e-9);
}

TEST(RealScore, OfTooFewStillsNoOffsetIsRemoved) {
  OneJoint one({0.11, 0.10});
  one.set.offsets_from_other_half = false;
  const StageScore few = ScoreStage(one.set, one.results, RealStage::kRaw, true, {true});
  EXPECT_FALSE(few.offset_removed);
  EXPECT_NEAR(few.mean_cm.value(), 10.5, 1e-9);
  OneJoint more({0.11, 0.10, 0.09});
  more.set.offsets_from_other_half = false;
  EXPECT_TRUE(ScoreStage(more.set, more.results, RealStage::kRaw, true, {true}).offset_removed);
  EXPECT_FALSE(ScoreStage(more.set, more.results, RealStage::kRaw, false, {true}).offset_removed);
}

TEST(RealScore, JointsAreCountedByTheirState) {
  OneJoint one({0.02, 0.12, 0.04, 0.3});
  const std::vector<bool> tracked = {true, true, false, false};
  for (size_t i = 0; i < tracked.size(); ++i) {
    one.results[i].errors[RealStage::kFinal] = one.results[i].errors[RealStage::kRaw];
    one.results[i].tracked = {tracked[i]};
  }
  const StateScore score = ScoreStates(one.set, one.results);
  EXPECT_EQ(score.tracked, 2);
  EXPECT_EQ(score.tracked_within_10cm, 1);
  EXPECT_EQ(score.others, 2) << "nobody was found in the last still";
  EXPECT_EQ(score.others_within_10cm, 1);
}

TEST(RealStills, AreScoredAtEveryStage) {
  const auto sets = ReadRealSets(test::SharedFolder(), 2);
  if (sets.empty()) GTEST_SKIP() << "no real depth with truth in " << test::SharedFolder();
  tracker::Tracker tracker;
  for (const RealSet& set : sets) {
    ASSERT_LE(set.stills.size(), 2u);
    const StillResult result = EvaluateStill(set, set.stills[0], tracker);
    if (result.bodies == 0) continue;
    for (const RealStage stage : kRealStages) {
      EXPECT_EQ(result.errors.at(stage).size(), set.joints.size()) << set.name;
    }
  }
}

// Eight people at a metre with the background cut: joints within a hand's breadth of the marks.
TEST(RealStills, OfNearPeopleAreWithinTenCentimetresOfTheMarks) {
  const auto sets = ReadRealSets(test::SharedFolder(), 3);
  const auto marked = std::find_if(sets.begin(), sets.end(),
                                   [](const RealSet& set) { return set.name == "skeltrack_v1"; });
  if (marked == sets.end()) GTEST_SKIP() << "skeltrack_v1 is not in " << test::SharedFolder();
  tracker::Tracker tracker;
  std::vector<StillResult> results;
  for (const RealStill& still : marked->stills) {
    results.push_back(EvaluateStill(*marked, still, tracker));
  }
  const std::vector<bool> all(marked->joints.size(), true);
  const StageScore score = ScoreStage(*marked, results, RealStage::kFinal, false, all);
  EXPECT_GE(score.within_10cm, 0.95);
}

TEST(RealVideo, SeatedPersonKeepsTheirId) {
  for (const RealVideo& video : ReadRealVideos(test::SharedFolder(), 10)) {
    if (video.name != "kinect_v1_seated_video") continue;
    tracker::Tracker tracker;
    const VideoScore score = EvaluateVideo(video, tracker);
    EXPECT_EQ(score.frames, 10);
    EXPECT_EQ(score.one_body, 10);
    EXPECT_EQ(score.identity_breaks, 0);
    return;
  }
  GTEST_SKIP() << "kinect_v1_seated_video is not in " << test::SharedFolder();
}

TEST(RealHoles, RemoveTheSameGivenShareOfReadingsEachTime) {
  const SharedWithMarks shared;
  shared.Mark("a.png Head 30 10\nb.png Head 31 11\n");
  const RealSet whole = ReadRealSets(shared.path(), 0).at(0);
  const auto share_missing = [](const RealSet& set) {
    int64_t missing = 0, pixels = 0;
    for (const RealStill& still : set.stills) {
      const auto& depth_mm = still.frame.depth_mm;
      missing += std::count(depth_mm.begin(), depth_mm.end(), 0);
      pixels += static_cast<int64_t>(depth_mm.size());
    }
    return static_cast<double>(missing) / static_cast<double>(pixels);
  };
  EXPECT_EQ(share_missing(whole), 0.0);
  EXPECT_NEAR(share_missing(WithHoles(whole, Holes::kTenth, 1)), 0.1, 0.02);
  EXPECT_NEAR(share_missing(WithHoles(whole, Holes::kThird, 1)), 0.3, 0.02);
  EXPECT_NEAR(share_missing(WithHoles(whole, Holes::kGrid, 1)), 5.0 / 9.0, 0.02);
  EXPECT_EQ(WithHoles(whole, Holes::kThird, 1).stills[1].frame.depth_mm,
            WithHoles(whole, Holes::kThird, 1).stills[1].frame.depth_mm);
}

TEST(RealHeld, MeasuresAgainWithTheNoiseOfStructuredLight) {
  depth::DepthFrame frame;
  frame.camera = depth::KinectV1Camera(320, 240);
  frame.depth_mm.assign(static_cast<size_t>(320) * 240, 2000);
  frame.depth_mm[7] = 0;
  const auto again_mm = MeasuredAgain(frame, 1).depth_mm;
  double sum2_mm2 = 0.0;
  for (const uint16_t depth_mm : again_mm) sum2_mm2 += std::pow(depth_mm - 2000.0, 2.0);
  sum2_mm2 -= std::pow(2000.0, 2.0);  // the one without a reading
  EXPECT_EQ(again_mm[7], 0);
  EXPECT_NEAR(std::sqrt(sum2_mm2 / static_cast<double>(again_mm.size())), 5.7, 0.1);  // 1.425 * 2^2
  EXPECT_EQ(again_mm, MeasuredAgain(frame, 1).depth_mm);
  EXPECT_NE(again_mm, MeasuredAgain(frame, 2).depth_mm);
}

TEST(RealHeld, CountsTheBodiesOfTheFirstAndOfTheLastFrame) {
  const auto sets = ReadRealSets(test::SharedFolder(), 1);
  if (sets.empty()) GTEST_SKIP() << "no real depth with truth in " << test::SharedFolder();
  tracker::Tracker tracker;
  HeldScore score;
  AddHeld(sets[0].stills[0].frame, 1, tracker, score);
  EXPECT_EQ(score.images, 1);
  EXPECT_EQ(score.first.one, 1);
  EXPECT_EQ(score.last.one, 1);
  EXPECT_EQ(score.last.bodies, 1);
}

// Of three joints raw has two: final's error of the third counts in neither mean.
TEST(RawAndFinal, AreAveragedOverTheSameJoints) {
  RealSet set;
  set.joints = {Joint::kHead, Joint::kHandLeft, Joint::kHandRight};
  StillResult result;
  result.has_truth = {true, true, true};
  result.errors[RealStage::kRaw] = {Eigen::Vector3d(0.04, 0, 0), Eigen::Vector3d(0, 0.08, 0),
                                    std::nullopt};
  result.errors[RealStage::kFinal] = {Eigen::Vector3d(0.02, 0, 0), Eigen::Vector3d(0, 0.04, 0),
                                      Eigen::Vector3d(0.5, 0, 0)};
  const RawAndFinal score = ScoreRawAndFinal(set, {result});
  EXPECT_EQ(score.joints, 2);
  EXPECT_NEAR(score.raw_cm, 6.0, 1e-9);
  EXPECT_NEAR(score.final_cm, 3.0, 1e-9);
  EXPECT_EQ(ScoreRawAndFinal(set, {}).joints, 0);
}

RealSet MakeSetOfOneHand(const std::string& peer) {
  RealSet set{.name = "one", .peer = peer};
  set.joints = {Joint::kHandLeft};
  set.joint_names = {"LHand"};
  set.offsets_from_other_half = false;
  return set;
}

// Stills of one joint with the errors of final and peer along x.
std::vector<StillResult> MakeStillsWithPeer(
    const std::vector<std::pair<double, double>>& errors_m) {
  std::vector<StillResult> results;
  for (const auto& [final_m, peer_m] : errors_m) {
    StillResult result;
    result.has_truth = {true};
    result.errors[RealStage::kFinal] = {Eigen::Vector3d(final_m, 0, 0)};
    result.errors[RealStage::kPeer] = {Eigen::Vector3d(peer_m, 0, 0)};
    results.push_back(result);
  }
  return results;
}

TEST(PeerAgreement, CountsStillsWhereBothContradictTheTruthTogether) {
  const RealSet set = MakeSetOfOneHand("A2J");
  const auto results =
      MakeStillsWithPeer({{0, 0}, {0, 0}, {0, 0}, {0, 0.3}, {0.2, 0}, {0.2, 0.22}, {-0.2, 0.2}});
  const PeerAgreement agreement = CompareWithPeer(set, results, 0);
  EXPECT_EQ(agreement.joints, 7);
  EXPECT_EQ(agreement.both, 3);
  EXPECT_EQ(agreement.only_final, 1);
  EXPECT_EQ(agreement.only_peer, 1);
  EXPECT_EQ(agreement.neither, 2);
  EXPECT_EQ(agreement.agreeing, 1);
}

TEST(PeerAgreement, IsMeasuredWithoutConstantOffsets) {
  const RealSet set = MakeSetOfOneHand("A2J");
  const auto results = MakeStillsWithPeer({{1.0, -1.0}, {1.0, -1.0}, {1.0, -1.0}, {1.2, -0.8}});
  const PeerAgreement agreement = CompareWithPeer(set, results, 0);
  EXPECT_EQ(agreement.both, 3);
  ASSERT_EQ(agreement.neither, 1);
  EXPECT_NEAR(agreement.to_truth_m[0], 0.2, 1e-9);
  EXPECT_NEAR(agreement.to_peer_m[0], 0.0, 1e-9);
}

TEST(PeerAgreement, IsOfEachJointAndOfAllInSetsWithAPeer) {
  const auto results = MakeStillsWithPeer({{0, 0}, {0, 0}, {0, 0}});
  EXPECT_TRUE(CompareJointsWithPeer(MakeSetOfOneHand(""), results).empty());
  const auto joints = CompareJointsWithPeer(MakeSetOfOneHand("A2J"), results);
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[0].first, "LHand");
  EXPECT_EQ(joints[1].first, "all");
  EXPECT_EQ(joints[1].second.both, 3);
}

}  // namespace
}  // namespace ossa::tools
