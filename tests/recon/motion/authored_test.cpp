#include "recon/motion/authored.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "recon/body/standard_body.h"
#include "recon/motion/mocap.h"

namespace ossa::recon {
namespace {

const std::vector<MotionClip>& Clips() {
  static const std::vector<MotionClip> clips = AuthoredClips();
  return clips;
}

/// Every posture of every clip with the name to blame.
template <typename Check>
void ForEveryPosture(const Check& check) {
  for (const MotionClip& clip : Clips()) {
    for (size_t f = 0; f < clip.frames.size(); ++f) {
      check(clip.name + " frame " + std::to_string(f), StandardPosture(clip.frames[f]), clip, f);
      if (testing::Test::HasFailure()) return;
    }
  }
}

double BendDegrees(const Posture& p, Joint a, Joint b, Joint c) {
  const Eigen::Vector3d u = (p[b] - p[a]).normalized(), v = (p[c] - p[b]).normalized();
  return std::acos(std::clamp(u.dot(v), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

TEST(AuthoredClips, HaveManyMinutesOfEveryActionOfTheDesign) {
  double seconds = 0.0;
  for (const MotionClip& clip : Clips()) {
    seconds += static_cast<double>(clip.frames.size()) * clip.frame_s;
  }
  EXPECT_GT(seconds, 20 * 60.0);
  const auto names = AuthoredActions();
  const std::set<std::string> actions(names.begin(), names.end());
  for (const char* action : {"walk",
                             "turn",
                             "sit",
                             "pick_up",
                             "carry",
                             "point",
                             "wave",
                             "clap",
                             "cross_arms",
                             "bend_over",
                             "roll_hands_up_down",
                             "roll_hands_forward_backward",
                             "golf",
                             "punch",
                             "kick",
                             "tai_chi",
                             "jumping_jacks",
                             "t_pose",
                             "stand",
                             "raise_arms",
                             "reach_around",
                             "hands_on_hips",
                             "hands_to_head",
                             "squat",
                             "lunge",
                             "sit_crossing_legs",
                             "deep_squat",
                             "hurdle_step",
                             "inline_lunge",
                             "side_lunge",
                             "sit_to_stand",
                             "leg_raise",
                             "shoulder_abduction",
                             "shoulder_scaption",
                             "shoulder_flexion",
                             "shoulder_extension",
                             "shoulder_rotation",
                             "trunk_rotation",
                             "flank_stretch"}) {
    EXPECT_TRUE(actions.contains(action)) << action;
  }
}

TEST(AuthoredClips, DependOnTheSeedOnly) {
  AuthoredOptions options;
  options.variations = 1;
  const auto a = AuthoredClips(options), b = AuthoredClips(options);
  options.seed = 2;
  const auto c = AuthoredClips(options);
  ASSERT_EQ(a.size(), b.size());
  bool other_differs = false;
  for (size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].frames.size(), b[i].frames.size());
    for (size_t f = 0; f < a[i].frames.size(); ++f) {
      ASSERT_EQ(a[i].frames[f].root_m, b[i].frames[f].root_m);
      ASSERT_EQ(a[i].frames[f].world_from_rest[19].coeffs(),
                b[i].frames[f].world_from_rest[19].coeffs());
    }
    other_differs = other_differs || c[i].frames.size() != a[i].frames.size();
  }
  EXPECT_TRUE(other_differs);
}

TEST(AuthoredClips, AreLoadedByTheWordAuthored) {
  const auto clips = LoadMocap({"authored"});
  EXPECT_EQ(clips.size(), Clips().size());
  EXPECT_TRUE(clips.front().name.starts_with("authored/"));
}

TEST(AuthoredClips, BendElbowsAndKneesWithinHumanLimits) {
  // Elbow flexion ends near 150 degrees, knee flexion near 145 (American Academy of Orthopaedic
  // Surgeons); 5 degrees more for a straight line between SDK joints that are not the hinge's.
  ForEveryPosture([](const std::string& where, const Posture& p, const MotionClip&, size_t) {
    EXPECT_LT(BendDegrees(p, Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft), 155)
        << where;
    EXPECT_LT(BendDegrees(p, Joint::kShoulderRight, Joint::kElbowRight, Joint::kWristRight), 155)
        << where;
    EXPECT_LT(BendDegrees(p, Joint::kHipLeft, Joint::kKneeLeft, Joint::kAnkleLeft), 150) << where;
    EXPECT_LT(BendDegrees(p, Joint::kHipRight, Joint::kKneeRight, Joint::kAnkleRight), 150)
        << where;
  });
}

TEST(AuthoredClips, KneesBendBackwards) {
  ForEveryPosture([](const std::string& where, const Posture& p, const MotionClip& clip, size_t f) {
    for (const Joint hip : {Joint::kHipLeft, Joint::kHipRight}) {
      const auto at = [&](size_t i) { return p.position_m[Index(hip) + i]; };
      const auto leg = RigBone(hip == Joint::kHipLeft ? "LeftLeg" : "RightLeg");
      // The knee lies before the line from hip to ankle, seen along the shin's own front.
      const Eigen::Vector3d front = clip.frames[f].world_from_rest[leg] * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d knee = at(1) - 0.5 * (at(0) + at(2));
      EXPECT_GT(knee.dot(front), -0.02) << where;
    }
  });
}

TEST(AuthoredClips, FeetStayAboveTheFloorAndOneTouchesIt) {
  const Posture rest = StandardPosture(RigPose());
  const double root = StandardRigRest().head_m[0].y();
  ForEveryPosture([&](const std::string& where, const Posture& p, const MotionClip& clip, size_t) {
    double lowest = 1.0;
    for (const Joint joint :
         {Joint::kAnkleLeft, Joint::kAnkleRight, Joint::kFootLeft, Joint::kFootRight}) {
      lowest = std::min(lowest, p[joint].y() - rest[joint].y() - root);
    }
    // The ball's joint sinks up to 1 cm while the foot rolls over heel or toes.
    EXPECT_GT(lowest, -0.012) << where;
    const bool jumps = clip.name.find("jumping") != std::string::npos;
    EXPECT_LT(lowest, jumps ? 0.12 : 0.012) << where;
  });
}

TEST(AuthoredClips, HandsAndElbowsStayOutOfTrunkAndHead) {
  ForEveryPosture([](const std::string& where, const Posture& p, const MotionClip&, size_t) {
    const Eigen::Vector3d low = p[Joint::kHipCenter], high = p[Joint::kShoulderCenter];
    for (const Joint joint :
         {Joint::kWristLeft, Joint::kWristRight, Joint::kElbowLeft, Joint::kElbowRight}) {
      const double part =
          std::clamp((p[joint] - low).dot(high - low) / (high - low).squaredNorm(), 0.0, 1.0);
      // The trunk of the standard body is 20 to 24 cm deep.
      EXPECT_GT((p[joint] - low - part * (high - low)).norm(), 0.095) << where << NameOf(joint);
      EXPECT_GT((p[joint] - p[Joint::kHead]).norm(), 0.11) << where << NameOf(joint);
    }
  });
}

TEST(AuthoredClips, MoveWithoutJumpsFromFrameToFrame) {
  ForEveryPosture([](const std::string& where, const Posture& p, const MotionClip& clip, size_t f) {
    if (f == 0) return;
    const Posture before = StandardPosture(clip.frames[f - 1]);
    for (size_t j = 0; j < kJointCount; ++j) {
      const double speed = (p.position_m[j] - before.position_m[j]).norm() / clip.frame_s;
      // Thrown hands and kicking feet reach about 10 m/s, nothing else does.
      EXPECT_LT(speed, 11.0) << where << kJointNames[j];
    }
  });
}

TEST(AuthoredClips, StandingFeetDoNotSlide) {
  std::map<std::string, double> slid_m;
  for (const MotionClip& clip : Clips()) {
    if (clip.name.find("/walk/") == std::string::npos) continue;
    for (size_t f = 1; f < clip.frames.size(); ++f) {
      const Posture p = StandardPosture(clip.frames[f]), q = StandardPosture(clip.frames[f - 1]);
      double slide = 1.0;  // of the foot that moves less: one of them stands
      for (const Joint foot : {Joint::kFootLeft, Joint::kFootRight}) {
        const Eigen::Vector3d d = p[foot] - q[foot];
        slide = std::min(slide, std::hypot(d.x(), d.z()));
      }
      slid_m[clip.name] = std::max(slid_m[clip.name], slide);
    }
  }
  for (const auto& [name, slide] : slid_m) EXPECT_LT(slide, 0.012) << name;
}

TEST(AuthoredClips, TPoseHasHorizontalArmsAndVerticalLegs) {
  for (const MotionClip& clip : Clips()) {
    if (clip.name.find("t_pose") == std::string::npos) continue;
    double best = 180.0;
    for (const RigPose& pose : clip.frames) {
      const Posture p = StandardPosture(pose);
      double worst = 0.0;
      for (const Joint shoulder : {Joint::kShoulderLeft, Joint::kShoulderRight}) {
        const auto wrist = static_cast<Joint>(Index(shoulder) + 2);
        Eigen::Vector3d out = EstimateHeading(pose) * Eigen::Vector3d::UnitX();
        if (shoulder == Joint::kShoulderRight) out = -out;
        const double cosine = (p[wrist] - p[shoulder]).normalized().dot(out);
        worst = std::max(worst, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi);
      }
      best = std::min(best, worst);
    }
    EXPECT_LT(best, 12.0) << clip.name;  // people's T-poses are a few degrees off
  }
}

TEST(AuthoredClips, UseBothSidesOfTheBody) {
  // Over all movers left and right hands are lifted about equally: sidedness is drawn by chance.
  double left = 0.0, right = 0.0;
  ForEveryPosture([&](const std::string&, const Posture& p, const MotionClip&, size_t) {
    left += std::max(0.0, p[Joint::kHandLeft].y() - p[Joint::kHipCenter].y());
    right += std::max(0.0, p[Joint::kHandRight].y() - p[Joint::kHipCenter].y());
  });
  EXPECT_NEAR(left / right, 1.0, 0.25);
}

}  // namespace
}  // namespace ossa::recon
