// Who is taken for a person at once, who after a few looks: looks are made up, no forest is needed.
#include <gtest/gtest.h>
#include <cmath>

#include "tools/tracker/find_people_internal.h"

namespace ossa::tracker {
namespace {

struct Look {
  double score = 0;
  float x_m = 0;             // of the thing's middle
  double arrived_share = 0;  // of what stands where the room behind was seen
  float area_m2 = 0.1F;
  bool has_head = true;
  bool alone = true;
  double hidden_share = 0.3;  // of its outline, by something nearer
};

class Newcomer : public testing::Test {
 protected:
  // A thing of 100 cells that a step of 4 cm moves by one column of 160.
  Found Seen(const Look& look) {
    Found found;
    found.perception.person_score = found.single_score = look.score;
    depth::Candidate& candidate = found.candidate;
    candidate.arrived_share = look.arrived_share;
    candidate.arrived_m2 = static_cast<float>(look.arrived_share) * look.area_m2;
    candidate.has_head = look.has_head;
    candidate.alone = look.alone;
    candidate.hidden_share = look.hidden_share;
    candidate.region.mean_m = {look.x_m, 0, 3};
    candidate.region.area_m2 = look.area_m2;
    const int column = 80 + static_cast<int>(std::lround(look.x_m / 0.04F));
    for (int row = 20; row < 120; ++row) candidate.region.cells.push_back(160 * row + column);
    return found;
  }

  // The frame in which it is accepted, of `frames` at 30 Hz; -1 for none.
  template <class LookAt>
  int AcceptedIn(int frames, bool fresh, const LookAt& look_at) {
    depth::Scene scene;
    FinderState state;
    for (int f = 0; f < frames; ++f) {
      scene.fresh = fresh && f == 0;
      Found found = Seen(look_at(f));
      if (Accepted(found, scene, f / 30.0, options_, state)) return f;
    }
    return -1;
  }
  FindOptions options_;
};

TEST_F(Newcomer, IsBelievedAtOnceInAFreshSceneAndElsewhereAfterThreeSureLooks) {
  EXPECT_EQ(AcceptedIn(1, true, [](int) { return Look{0.65}; }), 0);
  EXPECT_EQ(AcceptedIn(1, true, [](int) { return Look{0.85, 0, 0, 0.1F, false}; }), -1);
  EXPECT_EQ(AcceptedIn(1, true, [](int) { return Look{0.95, 0, 0, 0.1F, false}; }), 0);
  EXPECT_EQ(AcceptedIn(1, false, [](int) { return Look{0.65}; }), -1);
  EXPECT_EQ(AcceptedIn(3, false, [](int) { return Look{0.95}; }), 2);
  EXPECT_EQ(AcceptedIn(20, false, [](int f) { return Look{f < 2 ? 0.98 : 0.7}; }), -1);
}

TEST_F(Newcomer, ThatStandsLikeFurnitureIsNobodyHoweverOftenItIsLookedAt) {
  EXPECT_EQ(AcceptedIn(60, false, [](int) { return Look{0.85}; }), -1);
  // A poorer look of something that turns, and shows a quarter more, is somebody,
  const auto turns = [](int f) {
    return f < 10 ? Look{0.7} : Look{.score = 0.7, .arrived_share = 0.2, .area_m2 = 0.125F};
  };
  EXPECT_EQ(AcceptedIn(60, false, turns), 10);
  // ... but not of which somebody who passes uncovers a quarter more: it stands before nothing new.
  const auto uncovered = [](int f) { return Look{0.7, 0, 0, f < 10 ? 0.1F : 0.125F}; };
  EXPECT_EQ(AcceptedIn(60, false, uncovered), -1);
}

TEST_F(Newcomer, WhoCameInBehindOthersIsFollowedThroughLooksThatShowLittle) {
  // A head above somebody's shoulder, at 1.2 m/s: no cell is the same from one frame to the next.
  const auto at = [](int steps, double arrived_share) {
    return Look{0.04, 0.04F * static_cast<float>(steps), arrived_share};
  };
  const auto walks = [&](int f) { return at(f, 1); };
  EXPECT_EQ(AcceptedIn(60, false, walks), 13);  // 52 cm
  const auto beside_somebody = [&](int f) {
    Look look = at(f, 1);
    look.alone = false;
    return look;
  };
  EXPECT_EQ(AcceptedIn(60, false, beside_somebody), -1);
  const auto sways = [&](int f) { return at(f % 8 < 4 ? f % 4 : 4 - f % 4, 1); };
  EXPECT_EQ(AcceptedIn(60, false, sways), -1);
  const auto was_there = [&](int f) { return at(f, 0); };
  EXPECT_EQ(AcceptedIn(60, false, was_there), -1);
}

TEST_F(Newcomer, WhoCameAndIsSeenWholeMustLookLikeAPerson) {
  // A dog that walks by: nothing hides any of it.
  const auto walks = [](double score) {
    return [score](int f) {
      Look look{score, 0.04F * static_cast<float>(f), 1};
      look.hidden_share = 0;
      return look;
    };
  };
  EXPECT_EQ(AcceptedIn(60, false, walks(0.4)), -1);
  EXPECT_EQ(AcceptedIn(60, false, walks(0.65)), 0);
}

TEST_F(Newcomer, WhoCameStaysSomebodyWhileBendingDownAfterManyLooksOnly) {
  Look bent{0.1, 0, 1};
  bent.hidden_share = 0;
  FinderState state;
  for (const int looks : {20, 40}) {
    Found found = Seen(bent);
    found.looks = looks;
    found.moved = found.moving = true;
    EXPECT_EQ(Accepted(found, {}, 1.0, options_, state), looks == 40);
  }
}

TEST(MayBeTwo, WhoWasOneForLongIsOneWhileNoMoreShows) {
  FindOptions options;
  Found whole;
  whole.full_m2 = 0.45F;
  whole.candidate.region.area_m2 = 0.40F;  // bending down
  whole.looks = 12;
  EXPECT_TRUE(MayBeTwo(whole, options));
  whole.looks = 40;
  EXPECT_FALSE(MayBeTwo(whole, options));
  whole.candidate.region.area_m2 = 0.65F;  // somebody came
  EXPECT_TRUE(MayBeTwo(whole, options));
}

}  // namespace
}  // namespace ossa::tracker
