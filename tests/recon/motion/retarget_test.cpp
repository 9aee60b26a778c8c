#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <vector>

#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/motion/mocap.h"
#include "tests/recon/motion/bvh_texts.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr double kFloorHip_cm = 90.0;

/// A BVH of frames of 54 numbers each.
std::string BvhText(const std::vector<std::vector<double>>& frames, double frame_s = 1.0 / 30.0) {
  std::ostringstream text;
  text << TPoseHierarchy() << "MOTION\nFrames: " << frames.size() << "\nFrame Time: " << frame_s
       << "\n";
  for (const auto& frame : frames) {
    for (const double value : frame) text << value << ' ';
    text << '\n';
  }
  return text.str();
}

std::vector<double> Zeros() {
  std::vector<double> frame(kTPoseChannels, 0.0);
  frame[1] = kFloorHip_cm;
  return frame;
}

class RetargetTest : public testing::Test {
 protected:
  MotionClip Load(const std::string& text, const MocapOptions& options = {}) {
    std::ofstream(folder_.path() / "07_01.bvh") << text;
    return LoadMocap({folder_.path().string()}, options).at(0);
  }
  Posture ToPosture(const std::vector<double>& frame) {
    return StandardPosture(Load(BvhText({frame})).frames.at(0));
  }
  test::TemporaryFolder folder_;
};

Eigen::Vector3d Direction(const Posture& p, Joint from, Joint to) {
  return (p[to] - p[from]).normalized();
}

// 1e-6: numbers printed with six digits.
constexpr double kPrinted = 1e-5;

TEST_F(RetargetTest, TPoseOfTheSourceIsATPoseOfTheRig) {
  const Posture p = ToPosture(Zeros());
  for (const auto& [from, to, axis] :
       {std::tuple{Joint::kShoulderLeft, Joint::kElbowLeft, Eigen::Vector3d(1, 0, 0)},
        std::tuple{Joint::kElbowLeft, Joint::kWristLeft, Eigen::Vector3d(1, 0, 0)},
        std::tuple{Joint::kShoulderRight, Joint::kElbowRight, Eigen::Vector3d(-1, 0, 0)},
        std::tuple{Joint::kHipLeft, Joint::kKneeLeft, Eigen::Vector3d(0, -1, 0)},
        std::tuple{Joint::kKneeRight, Joint::kAnkleRight, Eigen::Vector3d(0, -1, 0)}}) {
    EXPECT_LT((Direction(p, from, to) - axis).norm(), kPrinted) << NameOf(to);
  }
  EXPECT_GT(Direction(p, Joint::kAnkleLeft, Joint::kFootLeft).z(), 0.9) << "toes point forwards";
}

TEST_F(RetargetTest, PalmsFaceDownInATPoseAndThumbsForward) {
  const RigPose pose = Load(BvhText({Zeros()})).frames.at(0);
  const RigRest& rest = StandardRigRest();
  for (const char* side : {"L", "R"}) {
    const auto hand = RigBone(side[0] == 'L' ? "LeftHand" : "RightHand");
    const auto thumb = RigBone(std::string(side) + "Thumb");
    const Eigen::Vector3d towards =
        pose.world_from_rest[hand] * (rest.tail_m[thumb] - rest.head_m[hand]);
    EXPECT_GT(towards.normalized().z(), 0.4) << side;
  }
}

TEST_F(RetargetTest, AnElbowBendsAsInTheSource) {
  auto frame = Zeros();
  frame[FirstRotation("lForeArm") + 2] = -90.0;  // about -y: the left forearm points forwards
  const Posture p = ToPosture(frame);
  EXPECT_LT((Direction(p, Joint::kElbowLeft, Joint::kWristLeft) - Eigen::Vector3d(0, 0, 1)).norm(),
            kPrinted);
}

TEST_F(RetargetTest, AKneeBendsBackwardsAndOnlyOnItsSide) {
  auto frame = Zeros();
  frame[FirstRotation("rShin") + 1] = 90.0;  // about x: the right shin points backwards
  const Posture p = ToPosture(frame);
  EXPECT_LT(
      (Direction(p, Joint::kKneeRight, Joint::kAnkleRight) - Eigen::Vector3d(0, 0, -1)).norm(),
      kPrinted);
  EXPECT_LT((Direction(p, Joint::kKneeLeft, Joint::kAnkleLeft) - Eigen::Vector3d(0, -1, 0)).norm(),
            kPrinted);
}

TEST_F(RetargetTest, ChildrenAreCarriedByTheirParents) {
  auto frame = Zeros();
  frame[FirstRotation("hip") + 1] = 90.0;        // turns to face +x
  frame[FirstRotation("lShldr")] = 90.0;         // left arm up
  frame[FirstRotation("lForeArm") + 2] = -90.0;  // forearm forwards, that is +x
  const Posture p = ToPosture(frame);
  EXPECT_LT(
      (Direction(p, Joint::kShoulderLeft, Joint::kElbowLeft) - Eigen::Vector3d(0, 1, 0)).norm(),
      kPrinted);
  EXPECT_LT((Direction(p, Joint::kElbowLeft, Joint::kWristLeft) - Eigen::Vector3d(1, 0, 0)).norm(),
            kPrinted);
  EXPECT_LT((Direction(p, Joint::kHipRight, Joint::kHipLeft) - Eigen::Vector3d(0, 0, -1)).norm(),
            kPrinted);
}

TEST_F(RetargetTest, IsIndependentOfUnitsAndPutsFeetOnTheFloor) {
  const Posture p = ToPosture(Zeros());
  // The source's soles are at 90 - 82 - 4 cm: close enough to be set on the floor exactly.
  const double sole =
      StandardPosture(RigPose())[Joint::kFootLeft].y() + StandardRigRest().head_m[0].y();
  EXPECT_NEAR(std::min(p[Joint::kFootLeft].y() - sole, p[Joint::kAnkleLeft].y() - 0.0692), 0.0,
              1e-3);
  EXPECT_NEAR(p[Joint::kHipCenter].y(), 0.92, 0.03);
}

TEST_F(RetargetTest, ALiftedArmLiftsItsClavicle) {
  const Posture low = ToPosture(Zeros());
  auto frame = Zeros();
  frame[FirstRotation("lShldr")] = 80.0;
  const Posture high = ToPosture(frame);
  EXPECT_GT(high[Joint::kShoulderLeft].y(), low[Joint::kShoulderLeft].y() + 0.01);
  EXPECT_NEAR(high[Joint::kShoulderRight].y(), low[Joint::kShoulderRight].y(), kPrinted);
}

// A left arm that turns by 60 degrees in the first step of three frames.
class TurningArm : public RetargetTest {
 protected:
  MotionClip LoadAtSteps(double step_s) {
    auto first = Zeros(), second = Zeros();
    second[FirstRotation("lShldr")] = 60.0;
    return Load(BvhText({first, second, second}, step_s));
  }
  static double FirstTurn_deg(const MotionClip& clip) {
    const auto arm = RigBone("LeftArm");
    return clip.frames[1].world_from_rest[arm].angularDistance(
               clip.frames[0].world_from_rest[arm]) *
           180.0 / std::numbers::pi;
  }
};

TEST_F(TurningArm, IsResampledToThirtyFramesASecondBySlerp) {
  const MotionClip clip = LoadAtSteps(0.1);
  ASSERT_EQ(clip.frames.size(), 7u);
  EXPECT_NEAR(FirstTurn_deg(clip), 20.0, 1e-3);
}

// Of 25 frames a second three last as long as three of 30, nearly: they are not the same moments.
TEST_F(TurningArm, ShortClipsOfOtherRatesAreResampledToo) {
  const MotionClip clip = LoadAtSteps(0.04);
  ASSERT_EQ(clip.frames.size(), 3u);
  EXPECT_NEAR(FirstTurn_deg(clip), 50.0, 1e-3);
}

TEST_F(RetargetTest, ClipsKnowTheirNameAndPerformer) {
  const MotionClip clip = Load(BvhText({Zeros()}));
  EXPECT_EQ(clip.name, "07_01");
  EXPECT_EQ(clip.subject, "07");
}

TEST_F(RetargetTest, UnknownNamesSuggestAMappingFile) {
  std::string text = BvhText({Zeros()});
  text.replace(text.find("lForeArm"), 8, "Elle");
  try {
    Load(text);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("LeftForeArm"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("mapping file"), std::string::npos) << error.what();
  }
}

TEST_F(RetargetTest, MappingFileNamesUnknownJoints) {
  std::string text = BvhText({Zeros()});
  text.replace(text.find("lForeArm"), 8, "Elle links");
  const auto mapping = folder_.path() / "names.txt";
  std::ofstream(mapping) << "# test\nHips = hip\nLowerBack = abdomen\nSpine1 = chest\nHead = head\n"
                            "LeftArm = lShldr\nLeftForeArm = Elle links\nRightArm = rShldr\n"
                            "RightForeArm = rForeArm # right\nLeftUpLeg = lThigh\nLeftLeg = lShin\n"
                            "LeftFoot = lFoot\nRightUpLeg = rThigh\nRightLeg = rShin\n"
                            "RightFoot = rFoot\nrest = frame 0\n";
  MocapOptions options;
  options.mapping_file = mapping.string();
  const Posture p = StandardPosture(Load(text, options).frames.at(0));
  EXPECT_LT((Direction(p, Joint::kElbowLeft, Joint::kWristLeft) - Eigen::Vector3d(1, 0, 0)).norm(),
            kPrinted);
}

TEST_F(RetargetTest, AFolderWithoutMocapIsRefused) {
  EXPECT_THROW(LoadMocap({folder_.path().string()}), InputError);
  EXPECT_THROW(LoadMocap({"/nonexistent"}), InputError);
}

}  // namespace
}  // namespace ossa::recon
