#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/motion/humanoid3d_internal.h"
#include "recon/motion/mocap.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// A standing humanoid; edit numbers by place in the row.
std::vector<double> Row() {
  std::vector<double> row(44, 0.0);
  row[0] = 1.0 / 30.0;
  row[2] = 0.89;
  for (const size_t quaternion : {4U, 8U, 12U, 16U, 21U, 25U, 30U, 35U, 39U}) row[quaternion] = 1.0;
  return row;
}

std::string Text(const std::vector<std::vector<double>>& rows) {
  std::ostringstream text;
  text.precision(12);
  text << "{\"Loop\": \"none\", \"Frames\": [";
  for (size_t r = 0; r < rows.size(); ++r) {
    text << (r ? ",[" : "[");
    for (size_t i = 0; i < rows[r].size(); ++i) text << (i ? "," : "") << rows[r][i];
    text << "]";
  }
  text << "]}";
  return text.str();
}

Posture ToPosture(const std::vector<double>& row) {
  test::TemporaryFolder folder;
  std::ofstream(folder.path() / "humanoid3d_test.txt") << Text({row});
  return StandardPosture(LoadMocap({folder.path().string()}).at(0).frames.at(0));
}

Eigen::Vector3d Direction(const Posture& p, Joint from, Joint to) {
  return (p[to] - p[from]).normalized();
}

// Numbers are printed with 12 digits.
constexpr double kPrinted = 1e-9;

TEST(Humanoid3d, StandsWithHangingArmsFacingOurFront) {
  const Posture p = ToPosture(Row());
  EXPECT_LT(
      (Direction(p, Joint::kShoulderLeft, Joint::kWristLeft) - Eigen::Vector3d(0, -1, 0)).norm(),
      kPrinted);
  EXPECT_LT((Direction(p, Joint::kHipLeft, Joint::kAnkleLeft) - Eigen::Vector3d(0, -1, 0)).norm(),
            kPrinted);
  EXPECT_GT(p[Joint::kHipLeft].x(), 0.0) << "left is +x once brought to our axes";
  EXPECT_GT(Direction(p, Joint::kAnkleLeft, Joint::kFootLeft).z(), 0.9);
}

TEST(Humanoid3d, KneesBendBackwardsAndElbowsForwards) {
  auto row = Row();
  row[20] = -0.5 * std::numbers::pi;  // right knee
  row[43] = 0.5 * std::numbers::pi;   // left elbow
  const Posture p = ToPosture(row);
  EXPECT_LT(
      (Direction(p, Joint::kKneeRight, Joint::kAnkleRight) - Eigen::Vector3d(0, 0, -1)).norm(),
      kPrinted);
  EXPECT_LT((Direction(p, Joint::kElbowLeft, Joint::kWristLeft) - Eigen::Vector3d(0, 0, 1)).norm(),
            kPrinted);
  EXPECT_LT(
      (Direction(p, Joint::kElbowRight, Joint::kWristRight) - Eigen::Vector3d(0, -1, 0)).norm(),
      kPrinted);
}

TEST(Humanoid3d, DamageIsRefusedWithFrameAndPlace) {
  const auto refusal = [](const std::string& text) {
    try {
      ParseHumanoid3d(text, "h.txt");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  auto short_row = Row(), no_quaternion = Row(), no_time = Row();
  short_row.pop_back();
  no_quaternion[12] = 0.0;
  no_time[0] = 0.0;
  EXPECT_NE(refusal(Text({Row(), short_row})).find("Frames[1]: expected 44 numbers, found 43"),
            std::string::npos);
  EXPECT_NE(refusal(Text({no_quaternion})).find("a unit quaternion at [12]"), std::string::npos);
  auto blended = Row();
  blended[12] = 0.6;
  EXPECT_EQ(refusal(Text({blended})), "accepted");
  EXPECT_NE(refusal(Text({no_time, Row()})).find("a frame time"), std::string::npos);
  EXPECT_NE(refusal("{\"Frames\": []}").find("h.txt"), std::string::npos);
  EXPECT_NE(refusal("[[[[[[[").find("expected JSON"), std::string::npos);
  EXPECT_NE(refusal("").find("expected JSON"), std::string::npos);
  std::string text = Text({Row()});
  text.replace(text.find("0.89"), 4, "\"up\"");
  EXPECT_NE(refusal(text).find("a number at [2], found string"), std::string::npos);
}

TEST(Humanoid3d, FetchedClipsLoadAndStandUpright) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::filesystem::path folder =
      (cache ? std::filesystem::path(cache) : std::filesystem::path(home ? home : "/") / ".cache") /
      "ossa" / "mocap";
  if (!std::filesystem::exists(folder / "humanoid3d_walk.txt")) {
    GTEST_SKIP() << "no clips in " << folder << ": run tools/fetch_mocap";
  }
  const auto clips = LoadMocap({folder.string()});
  EXPECT_EQ(clips.size(), 15u);
  for (const MotionClip& clip : clips) {
    if (clip.name != "humanoid3d_walk") continue;
    EXPECT_NEAR(static_cast<double>(clip.frames.size()) * clip.frame_s, 1.27, 0.1);
    for (const RigPose& pose : clip.frames) {
      const Posture p = StandardPosture(pose);
      EXPECT_GT(p[Joint::kHead].y(), 1.4);
      EXPECT_LT(p[Joint::kFootLeft].y(), 0.4);
      EXPECT_GT((EstimateHeading(pose) * Eigen::Vector3d::UnitZ()).z(), 0.8)
          << "walks where it faces";
    }
    EXPECT_GT(clip.frames.back().root_m.z() - clip.frames.front().root_m.z(), 0.8);
  }
}

}  // namespace
}  // namespace ossa::recon
