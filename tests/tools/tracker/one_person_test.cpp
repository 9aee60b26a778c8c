// What of the pieces and of the furniture around belongs to one person: made-up joints, no forest.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/find_people_internal.h"
#include "tools/tracker/measure_body_internal.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

recon::JointArray<int> OneTargetPerJoint() {
  recon::JointArray<int> targets;
  std::iota(targets.begin(), targets.end(), 0);
  return targets;
}

Perception SureOf(const recon::Posture& joints) {
  Perception perception;
  for (const Eigen::Vector3d& joint_m : joints.position_m) {
    forest::Proposal proposal;
    proposal.position_m = joint_m;
    proposal.confidence = 1;
    perception.proposals.push_back({proposal});
  }
  return perception;
}

// Somebody, and a box beside them that is held to be part of them.
class PersonWithABox : public testing::Test {
 protected:
  void SetUp() override {
    tests::CapsuleScene picture;
    picture.people = {PersonAt(0, 2.5)};
    picture.boxes = {{{-1.3, -0.4, 2.4}, {-0.9, -0.1, 2.6}}};
    picture.planes = tests::EmptyRoom();
    render_ = tests::Render(picture, depth::KinectV1Camera(320, 240));
    scene_.grid = depth::MakePointGrid(render_.frame.view(), render_.frame.camera, 6.0F);
    std::vector<int> cells;
    for (int cell = 0; cell < scene_.grid.cells(); ++cell) {
      if (scene_.grid.valid(cell) && scene_.grid.z(cell) < 3.0F &&
          scene_.grid.at(cell).y() > -0.95F)
        cells.push_back(cell);
    }
    found_.candidate.region = depth::MakeRegion(scene_.grid, std::move(cells));
    recon::Posture joints = render_.joints[0];
    for (const auto& [wrist, hand] :
         {std::pair(Joint::kWristLeft, Joint::kHandLeft), {Joint::kWristRight, Joint::kHandRight}})
      joints[hand] = joints[wrist] + 0.5 * (joints[hand] - joints[wrist]);  // too long for a hand
    found_.perception = SureOf(joints);
  }
  // Of the box's, and of all other cells held.
  std::pair<long, long> Held() const {
    const auto& cells = found_.candidate.region.cells;
    const long box = std::count_if(cells.begin(), cells.end(),
                                   [&](int cell) { return scene_.grid.at(cell).x() < -0.85F; });
    return {box, std::ssize(cells) - box};
  }
  tests::CapsuleRender render_;
  depth::Scene scene_;
  Found found_;
};

TEST_F(PersonWithABox, LosesTheBoxWhenAllBonesAreKnown) {
  const auto [box, person] = Held();
  ASSERT_GT(box, 40);
  TrimToBody(OneTargetPerJoint(), render_.frame, scene_, found_);
  EXPECT_EQ(Held(), std::pair(0L, person));
}

TEST_F(PersonWithABox, KeepsItWhenAnArmIsNotSeen) {  // it may be the arm
  const auto before = Held();
  found_.perception.proposals[Joint::kHandRight].clear();
  TrimToBody(OneTargetPerJoint(), render_.frame, scene_, found_);
  EXPECT_EQ(Held(), before);
}

// Upper and lower half of somebody, from two regions.
class Halves : public testing::Test {
 protected:
  void SetUp() override {
    const auto render = Rendered({PersonAt(0, 2.5)});
    scene_.grid = depth::MakePointGrid(render.frame.view(), render.frame.camera, 6.0F);
    std::vector<int> upper, lower;
    for (int cell = 0; cell < scene_.grid.cells(); ++cell) {
      const Eigen::Vector3f& p = scene_.grid.at(cell);
      if (scene_.grid.valid(cell) && p.z() < 3.0F && p.y() > -0.95F)
        (p.y() > 0 ? upper : lower).push_back(cell);
    }
    upper_.candidate.region = depth::MakeRegion(scene_.grid, std::move(upper));
    lower_.candidate.region = depth::MakeRegion(scene_.grid, std::move(lower));
  }
  bool Tried(double upper_score, double lower_score, int looks, bool stacked) {
    upper_.single_score = upper_score;
    lower_.single_score = lower_score;
    upper_.looks = lower_.looks = looks;
    return MayBeParts(scene_, options_, upper_, lower_, stacked);
  }
  depth::Scene scene_;
  FindOptions options_;
  Found upper_, lower_;
};

TEST_F(Halves, AreTriedAsOneWhenEitherLooksLikeAPersonWhileBothAreYoung) {
  EXPECT_TRUE(Tried(0.9, 0.1, 1, false));
  EXPECT_FALSE(Tried(0.5, 0.1, 1, false));
  EXPECT_FALSE(Tried(0.9, 0.1, options_.young_looks + 1, false));
  lower_.candidate.region = depth::MakeRegion(scene_.grid, {0, 1, 2});  // does not meet the upper
  EXPECT_FALSE(Tried(0.9, 0.1, 1, false));
}

TEST_F(Halves, AreTriedAtAnyAgeWhereTheyWouldBeTwoPeopleOneAboveTheOther) {
  EXPECT_TRUE(Tried(0.9, 0.8, options_.young_looks + 1, true));
  EXPECT_FALSE(Tried(0.9, 0.1, options_.young_looks + 1, true));
}

TEST_F(Halves, AreStackedAlsoBeforeASensorThatLooksDown) {
  EXPECT_TRUE(Stacked(scene_, upper_, lower_));
  const float tilt_rad = 0.5F;
  scene_.grid.up = {0, std::cos(tilt_rad), -std::sin(tilt_rad)};
  const auto at = [&](float height_m) {
    depth::Region region;
    region.mean_m = Eigen::Vector3f(0, -1, 3) + height_m * scene_.grid.up;
    region.low_m = region.mean_m - Eigen::Vector3f(0.2F, 0.2F, 0.1F);
    region.high_m = region.mean_m + Eigen::Vector3f(0.2F, 0.2F, 0.1F);
    return region;
  };
  upper_.candidate.region = at(1.2F);
  lower_.candidate.region = at(0.45F);
  EXPECT_TRUE(Stacked(scene_, upper_, lower_));
  scene_.grid.up = {0, 1, 0};  // as much farther away, and not below
  EXPECT_FALSE(Stacked(scene_, upper_, lower_));
}

TEST(MeasureBody, LeavesOutLimbsThatNobodyHas) {
  recon::Posture joints = tests::ComputeJoints(PersonAt(0, 2.5));
  const auto thigh_m = [&] {
    const auto body = MeasureBody(SureOf(joints), OneTargetPerJoint(), std::nullopt);
    return body[static_cast<size_t>(depth::Measure::kThigh)];
  };
  ASSERT_TRUE(thigh_m());
  // A knee half hidden is taken to be where the thigh ends that is seen.
  for (const auto& [hip, knee] :
       {std::pair(Joint::kHipLeft, Joint::kKneeLeft), {Joint::kHipRight, Joint::kKneeRight}}) {
    joints[knee] = joints[hip] + 0.3 * (joints[knee] - joints[hip]);
  }
  EXPECT_FALSE(thigh_m());
}

}  // namespace
}  // namespace ossa::tracker
