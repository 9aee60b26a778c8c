#include "tools/learning/evaluation_totals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace ossa::tools {
namespace {

constexpr auto kHandLeft = recon::Index(recon::Joint::kHandLeft);
constexpr auto kHead = recon::Index(recon::Joint::kHead);

// One person: every joint is found, only the head and the left hand are visible.
EvaluationTotals OnePerson() {
  EvaluationTotals totals;
  totals.frames = totals.people = 1;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    totals.joints[j] = 1;
    totals.rated[j] = {{0.9, true}};
  }
  for (const size_t j : {kHead, kHandLeft}) {
    totals.joints_visible[j] = 1;
    totals.rated_visible[j] = {{0.9, true}};
  }
  return totals;
}

TEST(EvaluationTotals, NeverVisibleJointsDoNotCountAsMissed) {
  EvaluationTotals totals = OnePerson();
  totals.rated_visible[kHandLeft] = {};
  const Evaluation e = Summarise(totals);
  EXPECT_EQ(e.map_10cm, 1.0);
  EXPECT_EQ(e.map_10cm_visible, 0.5);  // the head found, the hand missed
  EXPECT_EQ(e.ap_10cm_visible[kHandLeft], 0.0);
  EXPECT_TRUE(std::isnan(e.ap_10cm_visible[0]));
}

TEST(EvaluationTotals, AreEmptyWithoutPeople) {
  const Evaluation e = Summarise({});
  for (const double value : {e.pixel_accuracy, e.mean_class_accuracy, e.mean_common_accuracy,
                             e.map_10cm, e.map_10cm_visible, e.map_10cm_common}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(EvaluationTotals, PixelsOfHeldObjectsBelongToNoPerson) {
  EvaluationTotals totals = OnePerson();
  totals.pixels[5] = 10;
  totals.right[5] = 9;
  totals.pixels[recon::kOtherPart] = 90;
  const Evaluation e = Summarise(totals);
  EXPECT_EQ(e.pixel_accuracy, 0.9);
  EXPECT_EQ(e.mean_class_accuracy, 0.9);
  EXPECT_EQ(e.class_accuracy[recon::kOtherPart], 0.0);
}

TEST(EvaluationTotals, JsonLeavesOutClassesThatDoNotOccur) {
  const auto json = nlohmann::json::parse(EvaluationJson(Summarise(OnePerson())));
  EXPECT_EQ(json["ap_10cm_visible"].size(), 2u);
  EXPECT_EQ(json["map_10cm_visible"], 1.0);
  EXPECT_TRUE(json["pixel_accuracy"].is_null());
  EXPECT_TRUE(json["mean_common_accuracy"].is_null());
}

TEST(EvaluationTotals, WorstFramesComeFirst) {
  EvaluationTotals totals = OnePerson();
  for (const double accuracy : {0.9, 0.2, 0.5}) {
    totals.by_frame.push_back({static_cast<int64_t>(10 * accuracy), accuracy, {}});
  }
  const Evaluation e = Summarise(totals);
  ASSERT_EQ(e.worst_frames.size(), 3U);
  EXPECT_EQ(e.worst_frames[0].index, 2);
  EXPECT_EQ(e.worst_frames[2].index, 9);
}

TEST(EvaluationTotals, PageShowsTheConfusionMatrix) {
  EvaluationTotals totals = OnePerson();
  totals.confusion[1] = {};
  totals.confusion[1][1] = 3;
  totals.confusion[1][2] = 1;
  const std::string page = EvaluationHtml(Summarise(totals), "one");
  EXPECT_NE(page.find("LU head as LU head: 75.0 %"), std::string::npos);
  EXPECT_NE(page.find("LU head as RU head: 25.0 %"), std::string::npos);
}

TEST(EvaluationTotals, PageHasADashForClassesThatDoNotOccur) {
  const std::string page = EvaluationHtml(Summarise({}), "nobody");
  EXPECT_EQ(page.find("nan"), std::string::npos) << page;
  EXPECT_NE(page.find("Joint mAP at 10 cm: –,"), std::string::npos) << page;
}

// By hand: precisions at the hits 1 and 2/3, each a quarter of the recall.
TEST(AveragePrecision, IsTheAreaUnderTheMonotoneCurve) {
  EXPECT_DOUBLE_EQ(AveragePrecision({{0.9, true}, {0.8, false}, {0.7, true}, {0.1, false}}, 4),
                   (1 + 2 / 3.0) / 4);
}

TEST(AveragePrecision, IsOneForPerfectProposalsOfAnyNumber) {
  for (int64_t count = 1; count <= 1000; ++count) {
    const std::vector<RatedProposal> all(static_cast<size_t>(count), {0.5, true});
    ASSERT_EQ(AveragePrecision(all, count), 1.0) << count;
  }
}

}  // namespace
}  // namespace ossa::tools
