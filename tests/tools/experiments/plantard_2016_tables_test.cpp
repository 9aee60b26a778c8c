#include <gtest/gtest.h>

#include "tools/experiments/papers/plantard_2016_internal.h"

namespace ossa::tools {
namespace {

const std::vector<std::string> kLabels = {"raw", "shum-2013", "plantard-2016", "best"};

// Methods 10, 9, 8, 7 cm off in the first scenario, 1 cm more in each that follows; no frame over
// 20 cm but the raw one's.
std::vector<std::vector<ClipMetrics>> Clips(size_t scenarios) {
  std::vector<std::vector<ClipMetrics>> clips(kLabels.size());
  for (size_t m = 0; m < clips.size(); ++m) {
    for (size_t s = 0; s < scenarios; ++s) {
      ClipMetrics& clip = clips[m].emplace_back();
      clip.name = "scenario " + std::to_string(s + 1);
      clip.parent_relative_error_cm = 10.0 - static_cast<double>(m) + static_cast<double>(s);
      clip.fraction_frames_over_20cm = m == 0 ? 0.25 : 0.0;
    }
  }
  return clips;
}

TEST(FigureFive, HasMeansAndDeviations) {
  const auto clips = Clips(3);
  const Table table = MakePlantard2016FigureFive(kLabels, clips, clips);
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[0][1], "11.00 (1.00)");
  EXPECT_EQ(table.rows[0][3], "25.0 (0.0, 25.0-25.0)");
  EXPECT_EQ(table.rows[3][1], "8.00 (1.00)");
  EXPECT_EQ(table.note.find("Without"), std::string::npos);
}

TEST(FigureFive, LeavesScenariosWithoutComparableFramesOutOfTheMeans) {
  auto clips = Clips(3);
  clips[0][2] = {};
  clips[0][2].name = "scenario 3";
  const Table table = MakePlantard2016FigureFive(kLabels, clips, clips);
  EXPECT_EQ(table.rows[0][1], "10.50 (0.71)");
  EXPECT_EQ(table.rows[0][5], "25.0");
  EXPECT_EQ(table.rows[1][1], "9.50 (0.71)") << "over the same scenarios as raw";
  EXPECT_NE(table.note.find("Without 1 of 3 scenarios"), std::string::npos) << table.note;
}

TEST(FigureFive, HasDashesWhereNoFrameIsComparable) {
  std::vector<std::vector<ClipMetrics>> clips(kLabels.size(), std::vector<ClipMetrics>(1));
  const Table table = MakePlantard2016FigureFive(kLabels, clips, clips);
  for (const size_t column : {1u, 3u, 5u}) EXPECT_EQ(table.rows[2][column], "-");
}

/// A head and a shoulder centre, the head off by so many centimetres in each frame.
PairedTracks HeadOffBy(const std::vector<double>& off_cm) {
  PairedTracks pair;
  for (size_t f = 0; f < off_cm.size(); ++f) {
    SparsePosture truth;
    truth.present[2] = truth.present[3] = true;
    truth.position_m[3].y() = 0.2;
    pair.time_s.push_back(0.1 * static_cast<double>(f));
    pair.truth.push_back(truth);
    pair.result.push_back(truth);
    pair.result.back().position_m[3].x() = off_cm[f] / 100.0;
  }
  return pair;
}

TEST(FigureEight, ShowsTheWorstRawFrameOfEachScenario) {
  const std::vector<std::vector<PairedTracks>> pairs = {
      {HeadOffBy({1, 9, 2}), HeadOffBy({30, 3, 3})}, {HeadOffBy({1, 4, 8}), HeadOffBy({5, 9, 9})}};
  const Table table = MakePlantard2016FigureEight({"raw", "ours"}, pairs);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"2", "0.00", "30.00", "5.00"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"1", "0.10", "9.00", "4.00"}));
}

// Raw sees nobody in the last scenario: it must not count as an error of 0.
TEST(PaperTests, LeaveOutScenariosWithoutComparableFrames) {
  auto clips = Clips(9);
  const Table nine = MakePlantard2016Tests(kLabels, clips);
  auto ten = Clips(10);
  ten[0][9].parent_relative_error_cm.reset();
  ten[0][9].fraction_frames_over_20cm.reset();
  const Table with_nobody = MakePlantard2016Tests(kLabels, ten);
  EXPECT_FALSE(nine.rows.empty());
  EXPECT_EQ(with_nobody.rows, nine.rows);
}

}  // namespace
}  // namespace ossa::tools
