// Slow sources: recordings of a few frames a second.
#include "tools/people/frame_rate.h"

#include "tests/tools/people/scenes.h"
#include "tools/people/track_initiation.h"
#include "tools/people/update_track.h"

namespace ossa::people {
namespace {

TEST(FrameRate, IsTheShorterOfTheLastTwoSteps) {
  FrameRate rate;
  EXPECT_FALSE(rate.Update(1.0));
  EXPECT_NEAR(rate.Update(1.2).value(), 0.2, 1e-12) << "the only step so far";
  EXPECT_NEAR(rate.Update(1.4).value(), 0.2, 1e-12);
  EXPECT_NEAR(rate.Update(2.4).value(), 0.2, 1e-12) << "frames were lost";
  EXPECT_NEAR(rate.Update(3.4).value(), 1.0, 1e-12);
  EXPECT_FALSE(rate.Update(0.0)) << "another recording";
  EXPECT_NEAR(rate.Update(0.2).value(), 0.2, 1e-12);
}

TEST(AdaptToFrameRate, ChangesNothingAt30Hz) {
  const PeopleOptions usual, adapted = AdaptToFrameRate(usual, 1.0 / 30.0);
  EXPECT_EQ(adapted.initiation.unbroken_s, usual.initiation.unbroken_s);
  EXPECT_EQ(adapted.initiation.step_s, usual.initiation.step_s);
  EXPECT_EQ(adapted.initiation.step_m, usual.initiation.step_m);
  EXPECT_EQ(adapted.candidates.prediction.max_step_s, usual.candidates.prediction.max_step_s);
  EXPECT_EQ(adapted.candidates.prediction.same_depth_m, usual.candidates.prediction.same_depth_m);
  EXPECT_EQ(adapted.association.keep_cells_s, usual.association.keep_cells_s);
  EXPECT_EQ(adapted.association.same_depth_m, usual.association.same_depth_m);
  EXPECT_EQ(adapted.initiation.rest.lay_s, usual.initiation.rest.lay_s);
}

TEST(AdaptToFrameRate, SomebodyOnTheFloorMayBeHiddenInOneFrame) {
  constexpr double kStep_s = 0.9;
  const PeopleOptions slow = AdaptToFrameRate({}, kStep_s);
  EXPECT_GT(slow.initiation.rest.lay_s, kStep_s);
  EXPECT_EQ(slow.candidates.prediction.rest.lay_s, slow.initiation.rest.lay_s);
}

// Whoever stands still is accepted after three frames in a row; at 4 Hz they are 0.25 s apart.
TEST(AdaptToFrameRate, SomebodyWhoStandsIsAcceptedAt4Hz) {
  constexpr double kStep_s = 0.25;
  const auto is_accepted = [](const InitiationOptions& options) {
    std::vector<TentativeTrack> tentative;
    for (int f = 0; f < 4; ++f) {
      Detection detection;
      detection.score = detection.evidence.score = 0.95;
      detection.candidate.region.cells = {1, 2, 3};
      detection.candidate.region.area_m2 = 0.3F;
      if (DecidePerson(false, kStep_s * f, options, tentative, detection)) return true;
    }
    return false;
  };
  EXPECT_FALSE(is_accepted(InitiationOptions()));
  EXPECT_TRUE(is_accepted(AdaptToFrameRate({}, kStep_s).initiation));
}

constexpr double kSlowStep_s = 0.25;  // 4 Hz

// Share of a person's cells that are predicted to be theirs.
double ShareOfOwnCells(const CapsulePose& before, const CapsulePose& after,
                       const Eigen::Vector3f& velocity_m_s, const PredictionOptions& options) {
  const Proposed proposed = ProposeAlone(Shot({before}));
  Track track;
  track.velocity_m_s = velocity_m_s;
  track.cells = proposed.candidates.at(0).region.cells;
  track.z_m = CollectDepths(proposed.scene.grid, proposed.candidates[0].region);
  const Proposed now = ProposeAlone(Shot({after}));
  const Region& region = now.candidates.at(0).region;
  const auto owner = PredictOwners(now.scene.grid, {track}, kSlowStep_s, options);
  return static_cast<double>(CollectOverlaps(region, owner, 1)[0].size()) /
         static_cast<double>(region.cells.size());
}

// Walks 1.2 m/s, 0.3 m between two frames: no cell in common with the frame before.
TEST(AdaptToFrameRate, WalkersCellsArePredictedAFrameAheadAt4Hz) {
  const Eigen::Vector3f across_m_s(-1.2F, 0, 0);
  const auto share_of = [&](const PredictionOptions& options) {
    return ShareOfOwnCells(PersonAt(0, 2.5), PersonAt(-0.3, 2.5), across_m_s, options);
  };
  EXPECT_GT(share_of(AdaptToFrameRate({}, kSlowStep_s).candidates.prediction), 0.9);
  EXPECT_LT(share_of({}), 0.7);
}

// Seen once, so that the velocity is not known: 0.3 m farther away than any noise explains.
TEST(AdaptToFrameRate, WhoeverWalksAwayKeepsTheirCellsAt4Hz) {
  const auto share_of = [](const PredictionOptions& options) {
    return ShareOfOwnCells(PersonAt(0, 2.5), PersonAt(0, 2.8), Eigen::Vector3f::Zero(), options);
  };
  EXPECT_GT(share_of(AdaptToFrameRate({}, kSlowStep_s).candidates.prediction), 0.9);
  EXPECT_LT(share_of({}), 0.1);
}

}  // namespace
}  // namespace ossa::people
