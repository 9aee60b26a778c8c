#include "recon/motion/authored_floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recon/body/standard_body.h"
#include "recon/motion/mocap.h"

namespace ossa::recon {
namespace {

const std::vector<MotionClip>& Clips() {
  static const std::vector<MotionClip> clips = AuthoredFloorClips();
  return clips;
}

/// Over the clips of an action: the least and the greatest of what is measured of a posture.
template <typename Measure>
std::pair<double, double> Range(const std::string& action, const Measure& measure) {
  std::pair<double, double> range{1e9, -1e9};
  for (const MotionClip& clip : Clips()) {
    if (!clip.name.starts_with("authored-floor/" + action + "/")) continue;
    for (const RigPose& pose : clip.frames) {
      const double value = measure(StandardPosture(pose));
      range = {std::min(range.first, value), std::max(range.second, value)};
    }
  }
  return range;
}

double Height(const Posture& p, Joint joint) { return p[joint].y(); }

TEST(AuthoredFloor, PeopleLieKneelCrouchAndCrawl) {
  const auto head = [](const Posture& p) { return Height(p, Joint::kHead); };
  const auto hips = [](const Posture& p) { return Height(p, Joint::kHipCenter); };
  EXPECT_LT(Range("lie", head).first, 0.3);
  EXPECT_LT(Range("fall", head).first, 0.35);
  EXPECT_GT(Range("fall", head).second, 1.3) << "they stood before";
  EXPECT_LT(Range("crouch", hips).first, 0.55);
  EXPECT_LT(Range("sit_on_floor", hips).first, 0.3);
  const auto knee_over_ankle = [](const Posture& p) {
    return Height(p, Joint::kKneeRight) - Height(p, Joint::kAnkleRight);
  };
  EXPECT_LT(Range("kneel", knee_over_ankle).first, 0.08);
  const auto trunk_up = [](const Posture& p) {
    return (p[Joint::kShoulderCenter] - p[Joint::kHipCenter]).normalized().y();
  };
  EXPECT_LT(Range("crawl", trunk_up).first, 0.3);
}

TEST(AuthoredFloor, ElbowsComeNearKneesAndHandsBehindTheBack) {
  const auto elbow_to_knee = [](const Posture& p) {
    return std::min((p[Joint::kElbowLeft] - p[Joint::kKneeRight]).norm(),
                    (p[Joint::kElbowRight] - p[Joint::kKneeLeft]).norm());
  };
  EXPECT_LT(Range("elbow_to_knee", elbow_to_knee).first, 0.25);
  const auto behind = [](const Posture& p) {
    const Eigen::Vector3d left = p[Joint::kShoulderLeft] - p[Joint::kShoulderRight];
    const Eigen::Vector3d front = left.cross(Eigen::Vector3d::UnitY()).normalized();
    return front.dot(p[Joint::kHandLeft] - p[Joint::kSpine]);
  };
  EXPECT_LT(Range("arms_behind", behind).first, -0.1);
}

TEST(AuthoredFloor, FastTurnsTakeASecondForHalfATurn) {
  double fastest = 0;
  for (const MotionClip& clip : Clips()) {
    if (!clip.name.starts_with("authored-floor/turn_fast/")) continue;
    for (size_t f = 1; f < clip.frames.size(); ++f) {
      const double turn =
          EstimateHeading(clip.frames[f - 1]).angularDistance(EstimateHeading(clip.frames[f]));
      fastest = std::max(fastest, turn / clip.frame_s);
    }
  }
  EXPECT_GT(fastest, 3.1);
}

TEST(AuthoredFloor, BodiesTouchTheFloorWithoutPenetration) {
  for (const MotionClip& clip : Clips()) {
    for (const RigPose& pose : clip.frames) {
      const Posture p = StandardPosture(pose);
      double lowest_m = 1e9;
      for (const auto& joint_m : p.position_m) {
        ASSERT_TRUE(joint_m.allFinite());
        lowest_m = std::min(lowest_m, joint_m.y());
      }
      ASSERT_GE(lowest_m, 0.02) << clip.name;
      ASSERT_LE(lowest_m, 0.12) << clip.name;
    }
  }
}

TEST(AuthoredFloor, IsLoadedByItsWordAndDependsOnTheSeed) {
  MocapOptions options;
  const auto loaded = LoadMocap({"authored-floor"}, options);
  ASSERT_EQ(loaded.size(), AuthoredFloorActions().size() * 12);
  const auto again = LoadMocap({"authored-floor"}, options);
  for (size_t i = 0; i < loaded.size(); ++i) {
    ASSERT_EQ(loaded[i].frames.size(), again[i].frames.size());
    EXPECT_TRUE(loaded[i].frames.back().world_from_rest[20].isApprox(
        again[i].frames.back().world_from_rest[20]));
  }
  EXPECT_TRUE(LoadMocap({"authored"}, options)[0].name.starts_with("authored/"));
}

}  // namespace
}  // namespace ossa::recon
