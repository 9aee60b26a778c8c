// When a camera's mount is checked, decided and reconsidered, from what was tracked.
#include <gtest/gtest.h>

#include "tools/tracker/mount_finder_internal.h"

namespace ossa::tracker {
namespace {

BodyFrame LevelLook(double time_s) {
  BodyFrame tracked;
  tracked.time_s = time_s;
  tracked.floor = Eigen::Vector4d(0, 1, 0, 1);
  tracked.bodies.resize(1);
  return tracked;
}

TEST(MountFinder, IsCheckedOnceASecondUntilThreeChecksShowAPersonOnALevelFloor) {
  MountFinder finder;
  BodyFrame tracked;
  EXPECT_TRUE(finder.IsDue(tracked));
  tracked.time_s = 0.5;
  EXPECT_FALSE(finder.IsDue(tracked));
  tracked.time_s = 1.1;
  EXPECT_TRUE(finder.IsDue(tracked));
  for (const double time_s : {3.0, 4.0}) EXPECT_FALSE(finder.IsDue(LevelLook(time_s)));
  tracked.time_s = 5.0;
  EXPECT_TRUE(finder.IsDue(tracked));
  EXPECT_FALSE(finder.IsDue(LevelLook(6.0)));
  tracked.time_s = 7.0;
  EXPECT_FALSE(finder.IsDue(tracked));
}

TEST(MountFinder, IsCheckedIfOnlyTheFloorSuggestsALevelCamera) {
  MountFinder finder;
  for (int i = 0; i < 5; ++i) {
    BodyFrame tracked = LevelLook(i);
    tracked.bodies.clear();
    EXPECT_TRUE(finder.IsDue(tracked));
  }
}

// A person who works in front of a wall all day has no floor in view; from the ceiling the level
// forest is often confident, too, and wrong.
TEST(MountFinder, IsCheckedAsLongAsNoFloorIsSeen) {
  MountFinder finder;
  for (int i = 0; i < 5; ++i) {
    BodyFrame tracked = LevelLook(i);
    tracked.floor.reset();
    EXPECT_TRUE(finder.IsDue(tracked));
    finder.Confirm(MountFinder::View::kLevel);
  }
}

TEST(MountFinder, CandidatesCutBelowCountInLaterChecksWithoutPeople) {
  MountFinder finder;
  const BodyFrame nobody;
  EXPECT_FALSE(finder.MayBeCutBelow(nobody));
  finder.Confirm(MountFinder::View::kUnknown);
  EXPECT_TRUE(finder.MayBeCutBelow(nobody));
  EXPECT_FALSE(finder.MayBeCutBelow(LevelLook(1.0)));
}

TEST(MountFinder, IsDecidedByTheFirstCheckOrByThreeInARow) {
  using View = MountFinder::View;
  MountFinder first;
  EXPECT_TRUE(first.Confirm(View::kFromAbove));
  MountFinder later;
  EXPECT_FALSE(later.Confirm(View::kUnknown));
  EXPECT_FALSE(later.Confirm(View::kFromAbove));
  EXPECT_FALSE(later.Confirm(View::kLevel));
  EXPECT_FALSE(later.Confirm(View::kFromAbove));
  EXPECT_FALSE(later.Confirm(View::kUnknown));
  EXPECT_FALSE(later.Confirm(View::kFromAbove));
  EXPECT_TRUE(later.Confirm(View::kFromAbove));
}

// What a mount's models found in a frame: a body with this person score, or nobody.
BodyFrame Found(double person_score, bool on_a_floor = false) {
  BodyFrame found;
  if (on_a_floor) found.floor = Eigen::Vector4d(0, 1, 0, 1);
  if (person_score > 0.0) found.bodies.resize(1);
  for (Body& body : found.bodies) body.person_score = person_score;
  return found;
}

TEST(MountRevision, IsSettledByThreeFramesThatAgree) {
  using View = MountFinder::View;
  const BodyFrame nobody = Found(0.0);
  MountRevision above(0.0);
  EXPECT_EQ(above.Add(nobody, Found(0.8)), View::kUnknown);
  EXPECT_EQ(above.Add(nobody, nobody), View::kUnknown);
  EXPECT_EQ(above.Add(nobody, Found(0.8)), View::kUnknown);
  EXPECT_EQ(above.Add(nobody, Found(0.8)), View::kFromAbove);
  MountRevision level(0.0);
  EXPECT_EQ(level.Add(Found(0.7, true), nobody), View::kUnknown);
  EXPECT_EQ(level.Add(Found(0.99), Found(0.8)), View::kUnknown);
  EXPECT_EQ(level.Add(Found(0.99), Found(0.99)), View::kUnknown);
  EXPECT_EQ(level.Add(Found(0.99), Found(0.8)), View::kUnknown);
  EXPECT_EQ(level.Add(Found(0.7, true), nobody), View::kUnknown);
  EXPECT_EQ(level.Add(Found(0.99), nobody), View::kLevel);
}

// From the ceiling the level models are often confident of a person, too, but not where its own
// models find nobody.
TEST(MountRevision, ConfidentPersonWithoutAFloorIsEvidenceIfTheCeilingsModelsFindNobody) {
  using View = MountFinder::View;
  MountRevision revision(0.0);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(revision.Add(Found(0.95), Found(0.6)), View::kUnknown);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(revision.Add(Found(0.95), Found(0.0)), View::kUnknown);
  EXPECT_EQ(revision.Add(Found(0.95), Found(0.0)), View::kLevel);
}

TEST(MountRevision, IsDueOnceASecondAfterTheDecision) {
  MountRevision revision(2.0);
  EXPECT_FALSE(revision.IsDue(2.5));
  EXPECT_TRUE(revision.IsDue(3.0));
  EXPECT_FALSE(revision.IsDue(3.9));
  EXPECT_TRUE(revision.IsDue(1.0));  // the source started again
}

TEST(MountRevision, IsDueLessOftenWhileNobodyIsInView) {
  MountRevision revision(0.0);
  double time_s = 0.0;
  for (const double after_s : {1.0, 2.0, 4.0, 5.0, 5.0}) {
    EXPECT_FALSE(revision.IsDue(time_s + after_s - 0.1));
    EXPECT_TRUE(revision.IsDue(time_s += after_s));
    revision.Add(Found(0.0), Found(0.0));
  }
  EXPECT_TRUE(revision.IsDue(time_s += 5.0));
  revision.Add(Found(0.0), Found(0.8));
  EXPECT_TRUE(revision.IsDue(time_s += 1.0));
}

}  // namespace
}  // namespace ossa::tracker
