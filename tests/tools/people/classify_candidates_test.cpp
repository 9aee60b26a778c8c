// Merging and cropping of detections: synthetic joints, no forest.
#include "tools/people/classify_candidates.h"

#include "tests/tools/people/evidence.h"
#include "tests/tools/people/scenes.h"
#include "tools/people/detect_people.h"

namespace ossa::people {
namespace {

using recon::Joint;

// A person with a box beside them in the same segment.
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
    detection_.candidate.region = depth::MakeRegion(scene_.grid, std::move(cells));
    recon::Posture joints = render_.joints[0];
    for (const auto& [wrist, hand] :
         {std::pair(Joint::kWristLeft, Joint::kHandLeft), {Joint::kWristRight, Joint::kHandRight}})
      joints[hand] = joints[wrist] + 0.5 * (joints[hand] - joints[wrist]);  // too long for a hand
    detection_.evidence = MakeSureEvidence(joints);
  }
  // Shares of the box's and of all other cells that are kept.
  std::pair<long, long> Held() const {
    const auto& cells = detection_.candidate.region.cells;
    const long box = std::count_if(cells.begin(), cells.end(),
                                   [&](int cell) { return scene_.grid.at(cell).x() < -0.85F; });
    return {box, std::ssize(cells) - box};
  }
  tests::CapsuleRender render_;
  Scene scene_;
  Detection detection_;
};

TEST_F(PersonWithABox, LosesTheBoxWhenAllBonesAreKnown) {
  const auto [box, person] = Held();
  ASSERT_GT(box, 40);
  CropToBody(OneTargetPerJoint(), render_.frame, scene_, {}, detection_);
  EXPECT_EQ(Held(), std::pair(0L, person));
}

TEST_F(PersonWithABox, KeepsItWhenAnArmIsNotSeen) {  // it may be the arm
  const auto before = Held();
  detection_.evidence.proposals[recon::Index(Joint::kHandRight)].clear();
  CropToBody(OneTargetPerJoint(), render_.frame, scene_, {}, detection_);
  EXPECT_EQ(Held(), before);
}

// Upper and lower half of a person, from two regions.
class Halves : public testing::Test {
 protected:
  void SetUp() override {
    const auto render = Shot({PersonAt(0, 2.5)});
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
  bool Tried(double upper_score, double lower_score, int age, bool stacked) {
    upper_.evidence.score = upper_score;
    lower_.evidence.score = lower_score;
    upper_.age = lower_.age = age;
    return MayBePartsOfOnePerson(scene_, options_, upper_, lower_, stacked);
  }
  Scene scene_;
  PeopleOptions options_;
  Detection upper_, lower_;
};

TEST_F(Halves, MergeIfEitherScoresLikeAPersonWhileBothAreNew) {
  EXPECT_TRUE(Tried(0.9, 0.1, 1, false));
  EXPECT_FALSE(Tried(0.5, 0.1, 1, false));
  EXPECT_FALSE(Tried(0.9, 0.1, options_.initiation.early_age + 1, false));
  lower_.candidate.region =
      depth::MakeRegion(scene_.grid, {0, 1, 2});  // not adjacent to the upper one
  EXPECT_FALSE(Tried(0.9, 0.1, 1, false));
}

TEST_F(Halves, AreTriedAtAnyAgeIfStackedVertically) {
  EXPECT_TRUE(Tried(0.9, 0.8, options_.initiation.early_age + 1, true));
  EXPECT_FALSE(Tried(0.9, 0.1, options_.initiation.early_age + 1, true));
}

TEST_F(Halves, AreStackedAlsoForASensorTiltedDown) {
  EXPECT_TRUE(AreStacked(scene_, options_, upper_, lower_));
  const float tilt_rad = 0.5F;
  scene_.grid.up = {0, std::cos(tilt_rad), -std::sin(tilt_rad)};
  const auto at = [&](float height_m) {
    Region region;
    region.mean_m = Eigen::Vector3f(0, -1, 3) + height_m * scene_.grid.up;
    region.low_m = region.mean_m - Eigen::Vector3f(0.2F, 0.2F, 0.1F);
    region.high_m = region.mean_m + Eigen::Vector3f(0.2F, 0.2F, 0.1F);
    return region;
  };
  upper_.candidate.region = at(1.2F);
  lower_.candidate.region = at(0.45F);
  EXPECT_TRUE(AreStacked(scene_, options_, upper_, lower_));
  scene_.grid.up = {0, 1, 0};  // as much farther away, and not below
  EXPECT_FALSE(AreStacked(scene_, options_, upper_, lower_));
}

TEST_F(Halves, OfALeaningPersonAreStackedIfBothScoreLikePeople) {
  const auto at = [](float z_m, float y_m) {
    Region region;
    region.mean_m = {0, y_m, z_m};
    region.low_m = region.mean_m - Eigen::Vector3f(0.2F, 0.3F, 0.2F);
    region.high_m = region.mean_m + Eigen::Vector3f(0.2F, 0.3F, 0.2F);
    return region;
  };
  upper_.candidate.region = at(1.7F, 0.2F);
  lower_.candidate.region = at(2.1F, -0.2F);
  upper_.evidence.score = 1.0;
  lower_.evidence.score = 0.86;
  EXPECT_TRUE(AreStacked(scene_, options_, upper_, lower_));
  lower_.evidence.score = 0.1;  // a table
  EXPECT_FALSE(AreStacked(scene_, options_, upper_, lower_));
}

Detection DetectionOf(double score, Verifier verifier = Verifier::kForest, float z_m = 2.0F) {
  Detection detection;
  detection.score = score;
  detection.candidate.region.mean_m.z() = z_m;
  detection.verifier = verifier;
  return detection;
}

// Shares as of people and of coats on stands in rendered rooms.
TEST(IsPoorBodyFit, ThresholdIsHigherBesideAPerson) {
  const InitiationOptions options;
  const ExplainedShares coat{0.71, 0.58}, person{0.93, 0.89}, cupboard{0.46, 0.2};
  EXPECT_FALSE(IsPoorBodyFit(coat, DetectionOf(0.87), false, options));
  EXPECT_TRUE(IsPoorBodyFit(coat, DetectionOf(0.87), true, options));
  EXPECT_FALSE(IsPoorBodyFit(person, DetectionOf(0.9), true, options));
  EXPECT_TRUE(IsPoorBodyFit(cupboard, DetectionOf(0.9), false, options));
}

// Shares as of a man at a desk, and of a lamp behind one.
TEST(IsPoorBodyFit, ThresholdIsHigherWhereTheNetworkDisagrees) {
  const InitiationOptions options;
  const ExplainedShares man{0.91, 0.83}, lamp{0.82, 0.63};
  EXPECT_FALSE(IsPoorBodyFit(man, DetectionOf(0.97, Verifier::kSurfaceFit), false, options));
  EXPECT_TRUE(IsPoorBodyFit(lamp, DetectionOf(0.97, Verifier::kSurfaceFit), false, options));
  EXPECT_FALSE(IsPoorBodyFit(lamp, DetectionOf(0.9), false, options));
  // Near the sensor much of a person is outside the image.
  const Detection near = DetectionOf(0.97, Verifier::kSurfaceFit, 0.8F);
  EXPECT_FALSE(IsPoorBodyFit(lamp, near, false, options));
}

// A long-lived track, a second one, and a part that belongs to neither so far.
struct TracksAndPart {
  TracksAndPart() {
    tracks[0].mean_m = {0, 0, 3.0F};
    tracks[0].age = tracks[1].age = user.age = options.classification.mature_age + 1;
    user.candidate.track = 0;
    part.candidate.region.mean_m = {0.1F, 0, 3.6F};
    part.candidate.may_return_as = {1};
  }
  bool MayReturn() const { return MayReturnBeside(PointGrid{}, part, user, tracks, 0.0, options); }
  PeopleOptions options;
  std::vector<Track> tracks{2};
  Detection user, part;
};

TEST(MayReturnBeside, IsWhereALostTrackIsExpectedAndTheUserIsNot) {
  EXPECT_TRUE(TracksAndPart().MayReturn());
  TracksAndPart near;
  near.part.candidate.region.mean_m.z() = 3.2F;
  EXPECT_FALSE(near.MayReturn());
  TracksAndPart nobody_lost;
  nobody_lost.part.candidate.may_return_as.clear();
  EXPECT_FALSE(nobody_lost.MayReturn());
  TracksAndPart young;  // it may be a chance detection of half a person
  young.user.age = young.options.classification.mature_age;
  EXPECT_FALSE(young.MayReturn());
}

TEST(IsOfOtherTrack, IsWhatWasCutOffALongLivedTrack) {
  TracksAndPart scene;
  EXPECT_FALSE(IsOfOtherTrack(scene.part, scene.user, scene.tracks));  // nobody's
  scene.part.candidate.owner = 0;
  EXPECT_FALSE(IsOfOtherTrack(scene.part, scene.user, scene.tracks));
  scene.part.candidate.owner = 1;
  EXPECT_TRUE(IsOfOtherTrack(scene.part, scene.user, scene.tracks));
  scene.tracks[1].age = 1;
  EXPECT_FALSE(IsOfOtherTrack(scene.part, scene.user, scene.tracks));
}

TEST(FindSegmentOf, IsWhereTheTrackIsPredictedAndNotTheFirstHead) {
  PointGrid grid;
  grid.width = 4, grid.height = 1;
  grid.camera.fx = 500;
  grid.point_m.assign(4, Eigen::Vector3f(0, 0, 2));
  Track track;
  track.cells = {1, 2, 3};
  track.z_m = {2, 2, 2};
  std::vector<Candidate> segments(2);
  segments[0].region.cells = {0, 1};
  segments[1].region.cells = {2, 3};
  EXPECT_EQ(FindSegmentOf(grid, track, segments, 0.0), 1U);
  track.cells = {1, 2};
  track.z_m = {2, 2};
  EXPECT_EQ(FindSegmentOf(grid, track, segments, 0.0), 0U) << "equal";
}

TEST(MayBeTwoPeople, ALongLivedTrackIsNotSplitWhileItsSurfaceDoesNotGrow) {
  ClassificationOptions options;
  Detection whole;
  whole.prior.full_m2 = 0.45F;
  whole.candidate.region.area_m2 = 0.40F;  // bending down
  whole.age = 12;
  EXPECT_TRUE(MayBeTwoPeople(whole, options));
  whole.age = 40;
  EXPECT_FALSE(MayBeTwoPeople(whole, options));
  whole.candidate.region.area_m2 = 0.65F;  // a second person came
  EXPECT_TRUE(MayBeTwoPeople(whole, options));
}

}  // namespace
}  // namespace ossa::people
