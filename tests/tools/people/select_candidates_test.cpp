// Which candidates are classified in a frame: synthetic candidates, no forest.
#include <gtest/gtest.h>

#include "recon/filters/frame_steps.h"
#include "tools/people/detect_people.h"
#include "tools/people/options.h"
#include "tools/people/track_initiation.h"

namespace ossa::people {
namespace {

// A rejected candidate that is seen again after a delay in some of its 100 cells: whether it is
// classified again.
bool IsWorthClassifying(double score, double later_s, int cells = 100) {
  Candidate candidate;
  TentativeTrack before;
  for (int cell = 0; cell < 100; ++cell) {
    before.cells.push_back(cell);
    if (cell < cells) candidate.region.cells.push_back(cell);
  }
  before.mean_score = score;
  std::vector<TentativeTrack> tentative = {before};
  std::vector<Decision> decided;
  const auto selected =
      SelectCandidates({candidate}, false, later_s, PeopleOptions{}, tentative, decided);
  EXPECT_EQ(selected.size() + decided.size(), 1U);
  if (!decided.empty()) {
    EXPECT_EQ(decided[0].rule, Rule::kRejectedBefore);
  }
  return !selected.empty();
}

TEST(SelectCandidates, RejectedCandidatesAreClassifiedAgainOnlyLater) {
  EXPECT_FALSE(IsWorthClassifying(0.1, 0.1));
  EXPECT_TRUE(IsWorthClassifying(0.1, 0.3));
  EXPECT_TRUE(IsWorthClassifying(0.5, 0.1));
  // An object is the same if most of the larger segment's cells are common.
  EXPECT_FALSE(IsWorthClassifying(0.1, 0.1, 61));
  EXPECT_TRUE(IsWorthClassifying(0.1, 0.1, 60));
}

TEST(SelectCandidates, RejectedCandidatesWhereALostTrackIsExpectedDoNotWait) {
  std::vector<Candidate> candidates(2);
  std::vector<TentativeTrack> tentative(2);
  for (int i = 0; i < 2; ++i) {
    candidates[static_cast<size_t>(i)].region.cells = {i};
    tentative[static_cast<size_t>(i)].cells = {i};
  }
  candidates[1].may_return_as = {0};
  std::vector<Decision> decided;
  const auto selected =
      SelectCandidates(candidates, false, 0.04, PeopleOptions{}, tentative, decided);
  ASSERT_EQ(selected.size(), 1U);
  EXPECT_EQ(selected[0].region.cells[0], 1);
}

// What scored like a person a moment ago, and is a part of a larger region now.
TEST(SelectCandidates, RegionsWithALikelyPersonInThemDoNotWait) {
  const auto holds_likely = [](double score, int cells_then, int common) {
    Candidate candidate;
    for (int cell = 0; cell < 100; ++cell) candidate.region.cells.push_back(cell);
    std::vector<TentativeTrack> tentative(2);
    tentative[0].cells = candidate.region.cells;  // the same region scored low, too
    tentative[1].mean_score = score;
    for (int i = 0; i < cells_then; ++i) tentative[1].cells.push_back(100 - common + i);
    std::vector<Decision> decided;
    const auto selected =
        SelectCandidates({candidate}, false, 0.1, PeopleOptions{}, tentative, decided);
    EXPECT_EQ(selected.size() + decided.size(), 1U);
    return !selected.empty() && selected[0].holds_likely_person;
  };
  EXPECT_TRUE(holds_likely(0.95, 50, 50));
  EXPECT_TRUE(holds_likely(0.95, 50, 45));
  EXPECT_FALSE(holds_likely(0.95, 50, 35));  // most of it is elsewhere
  EXPECT_FALSE(holds_likely(0.8, 50, 50));
  EXPECT_FALSE(holds_likely(0.95, 70, 70));  // nearly all of the region
}

// Three rejected at once: one is classified per frame, the one that waited longest, and none twice
// before the others; none is deleted earlier.
TEST(SelectCandidates, ClassifiesOneLowScoringCandidatePerFrame) {
  std::vector<Candidate> candidates(3);
  std::vector<TentativeTrack> tentative(3);
  for (int i = 0; i < 3; ++i) {
    candidates[static_cast<size_t>(i)].region.cells = {i};
    tentative[static_cast<size_t>(i)].cells = {i};
  }
  std::vector<int> order;
  const PeopleOptions options;
  for (int frame = 1; frame <= 16; ++frame) {
    std::vector<Decision> decided;
    const auto selected =
        SelectCandidates(candidates, false, frame / 30.0, options, tentative, decided);
    ASSERT_LE(selected.size(), 1U) << frame;
    EXPECT_EQ(selected.size() + decided.size(), 3U);
    if (selected.empty()) continue;
    EXPECT_TRUE(selected[0].recently_rejected);
    order.push_back(selected[0].region.cells[0]);
    tentative[static_cast<size_t>(order.back())].last_seen_s = frame / 30.0;
  }
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 0}));
}

// A camera with a low frame rate: none waits for more than twice as long.
TEST(SelectCandidates, LowScoringCandidatesAreClassifiedWithinABound) {
  std::vector<Candidate> candidates(3);
  std::vector<TentativeTrack> tentative(3);
  for (int i = 0; i < 3; ++i) {
    candidates[static_cast<size_t>(i)].region.cells = {i};
    tentative[static_cast<size_t>(i)].cells = {i};
  }
  std::vector<Decision> decided;
  const PeopleOptions options;
  const double late_s = options.classification.max_retry_s;
  const auto selected = SelectCandidates(candidates, false, late_s, options, tentative, decided);
  EXPECT_EQ(selected.size(), 3U);
}

TEST(SelectCandidates, TentativeTracksSurviveTimestampJitter) {
  EXPECT_EQ(depth::SceneOptions{}.jitter_s, recon::FrameSteps::kJitter_s);
  for (const auto& [later_s, is_known] : {std::pair(0.004, true), {0.006, false}}) {
    std::vector<TentativeTrack> tentative(1);
    tentative[0].last_seen_s = 1.0 + later_s;
    std::vector<Decision> decided;
    SelectCandidates({}, false, 1.0, PeopleOptions{}, tentative, decided);
    EXPECT_EQ(!tentative.empty(), is_known) << later_s;
  }
}

TEST(SelectCandidates, ClassifiesTheLargestIfThereAreTooMany) {
  PeopleOptions options;
  options.classification.max_candidates = 1;
  Candidate large, small;
  large.region.area_m2 = 0.5F, small.region.area_m2 = 0.1F;
  large.region.cells = {1}, small.region.cells = {2};
  std::vector<TentativeTrack> tentative;
  std::vector<Decision> decided;
  const auto selected = SelectCandidates({large, small}, true, 0, options, tentative, decided);
  ASSERT_EQ(selected.size(), 1U);
  EXPECT_EQ(selected[0].region.cells, large.region.cells);
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_EQ(decided[0].rule, Rule::kCandidateLimit);
}

TEST(ThoroughSearch, IsDueFromTimeToTimeUntilSomebodyIsTracked) {
  constexpr double kEvery_s = 0.5;
  ThoroughSearch search;
  EXPECT_TRUE(search.IsDue(true, false, 0.0, kEvery_s));
  search.Note(0.0, false);
  EXPECT_FALSE(search.IsDue(false, false, 0.4, kEvery_s));
  EXPECT_TRUE(search.IsDue(false, false, 0.5, kEvery_s));
  EXPECT_FALSE(search.IsDue(false, true, 0.5, kEvery_s));
  search.Note(0.5, true);
  EXPECT_TRUE(search.IsDue(false, false, 0.53, kEvery_s));  // until they are accepted
  EXPECT_FALSE(search.IsDue(false, true, 0.53, kEvery_s));
  search.Note(0.53, false);
  EXPECT_FALSE(search.IsDue(false, false, 0.56, kEvery_s));
  EXPECT_TRUE(search.IsDue(false, false, 0.1, kEvery_s));  // the clock started again
  int in_a_row = 0;
  for (double time_s = 2.0; search.IsDue(false, false, time_s, kEvery_s); time_s += 0.03) {
    search.Note(time_s, true);
    ASSERT_LT(++in_a_row, 20);
  }
  EXPECT_GE(in_a_row, InitiationOptions{}.standing_observations);
}

}  // namespace
}  // namespace ossa::people
