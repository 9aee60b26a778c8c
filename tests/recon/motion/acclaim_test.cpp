#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/motion/acclaim_internal.h"
#include "recon/motion/mocap.h"
#include "tests/recon/motion/acclaim_texts.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

const std::string kHeader = "#!OML:ASF x.asf\n:FULLY-SPECIFIED\n:DEGREES\n";
const std::string kStanding = "1\nroot 0 15 0 0 0 0\n";

class AcclaimTest : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  MotionClip Load(const std::string& amc, const std::string& asf = TPoseAsf()) {
    Write("05.asf", asf);
    Write("05_01.amc", amc);
    return LoadMocap({folder_.path().string()}).at(0);
  }
  Posture ToPosture(const std::string& bones) {
    return StandardPosture(Load(kHeader + kStanding + bones).frames.at(0));
  }
  std::string Refusal(const std::string& amc, const std::string& asf = TPoseAsf()) {
    try {
      Load(amc, asf);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return std::string(error.what()).substr(folder_.path().string().size() + 1);
    }
    return "accepted";
  }
  test::TemporaryFolder folder_;
};

Eigen::Vector3d Direction(const Posture& p, Joint from, Joint to) {
  return (p[to] - p[from]).normalized();
}

void ExpectAlong(const Eigen::Vector3d& direction, const Eigen::Vector3d& expected) {
  EXPECT_LT((direction - expected).norm(), 1e-9) << direction.transpose();  // rounding only
}

TEST_F(AcclaimTest, TheZeroPoseOfATPoseSkeletonIsATPose) {
  const Posture p = ToPosture("");
  ExpectAlong(Direction(p, Joint::kShoulderLeft, Joint::kWristLeft), {1, 0, 0});
  ExpectAlong(Direction(p, Joint::kShoulderRight, Joint::kWristRight), {-1, 0, 0});
  ExpectAlong(Direction(p, Joint::kHipRight, Joint::kAnkleRight), {0, -1, 0});
  EXPECT_GT(Direction(p, Joint::kAnkleLeft, Joint::kFootLeft).z(), 0.9);
}

TEST_F(AcclaimTest, BonesTurnAboutTheirOwnAxes) {
  // C M C^-1 with C = 30 degrees about z: the elbow turns about y tilted by 30 degrees.
  const Posture p = ToPosture("lradius 0 -90 0\nrtibia 90 0 0\n");
  const double tilt = 30.0 * std::numbers::pi / 180.0;
  const Eigen::Vector3d axis(-std::sin(tilt), std::cos(tilt), 0.0);
  const Eigen::Vector3d turned =
      Eigen::AngleAxisd(-0.5 * std::numbers::pi, axis) * Eigen::Vector3d::UnitX();
  ExpectAlong(Direction(p, Joint::kElbowLeft, Joint::kWristLeft), turned);
  ExpectAlong(Direction(p, Joint::kKneeRight, Joint::kAnkleRight), {0, 0, -1});
  ExpectAlong(Direction(p, Joint::kElbowRight, Joint::kWristRight), {-1, 0, 0});
}

TEST_F(AcclaimTest, DegreesOfFreedomTurnInTheirOrderFirstInnermost) {
  // rx then rz about fixed axes: the shin goes back by rx, rz leaves it in the y-z plane's image.
  const Posture p = ToPosture("lhumerus 0 0 90\nltibia 90 0 90\n");
  ExpectAlong(Direction(p, Joint::kShoulderLeft, Joint::kElbowLeft), {0, 1, 0});
  ExpectAlong(Direction(p, Joint::kKneeLeft, Joint::kAnkleLeft), {0, 0, -1});
}

TEST_F(AcclaimTest, RootMovesTheWholeBody) {
  const Posture p =
      StandardPosture(Load(kHeader + "1\nroot 10 15 -3 0 90 0\nltibia 90 0 0\n").frames.at(0));
  ExpectAlong(Direction(p, Joint::kKneeLeft, Joint::kAnkleLeft), {-1, 0, 0});
  ExpectAlong(Direction(p, Joint::kShoulderLeft, Joint::kElbowLeft), {0, 0, -1});
}

TEST_F(AcclaimTest, RadiansInTheMotionOverruleTheSkeleton) {
  const Posture p = StandardPosture(
      Load(":FULLY-SPECIFIED\n:RADIANS\n" + kStanding + "rtibia 1.5707963267948966 0 0\n")
          .frames.at(0));
  ExpectAlong(Direction(p, Joint::kKneeRight, Joint::kAnkleRight), {0, 0, -1});
}

TEST_F(AcclaimTest, FramesAt120HertzBecomeThirty) {
  std::string amc = kHeader;
  for (int f = 1; f <= 121; ++f) amc += std::to_string(f) + "\nroot 0 15 0 0 0 0\n";
  EXPECT_EQ(Load(amc).frames.size(), 31u);
}

TEST_F(AcclaimTest, WarnsOnceOfTheAssumedRateUnlessGiven) {
  std::string amc = kHeader;
  for (int f = 1; f <= 61; ++f) amc += std::to_string(f) + "\nroot 0 15 0 0 0 0\n";
  Write("05.asf", TPoseAsf());
  Write("05_01.amc", amc);
  Write("05_02.amc", amc);
  const auto assumed = LoadMocap({folder_.path().string()});
  ASSERT_EQ(assumed.at(0).warnings.size(), 1u);
  EXPECT_NE(assumed[0].warnings[0].find("05_01.amc: AMC files state no rate: read at 120"),
            std::string::npos);
  EXPECT_TRUE(assumed.at(1).warnings.empty());
  MocapOptions options;
  options.amc_hz = 60.0;
  const auto given = LoadMocap({folder_.path().string()}, options);
  EXPECT_TRUE(given.at(0).warnings.empty());
  EXPECT_EQ(given[0].frames.size(), 31u);
}

TEST_F(AcclaimTest, WarnsOfARateThatNoFileUses) {
  MocapOptions options;
  options.amc_hz = 60.0;
  std::vector<std::string> warnings;
  for (const MotionClip& clip : LoadMocap({"authored-floor"}, options)) {
    warnings.insert(warnings.end(), clip.warnings.begin(), clip.warnings.end());
  }
  EXPECT_EQ(warnings, std::vector<std::string>{"--amc-fps is not used: no file is an AMC file"});
}

TEST_F(AcclaimTest, BonesLeftOutOfAFrameStayAsTheyWere) {
  const MotionClip clip = Load(kHeader + kStanding + "rtibia 90 0 0\n" +
                               "2\nroot 0 15 0 0 0 0\n3\nroot 0 15 0 0 0 0\n" +
                               "4\nroot 0 15 0 0 0 0\n5\nroot 0 15 0 0 0 0\n");
  ASSERT_EQ(clip.frames.size(), 2u);
  ExpectAlong(Direction(StandardPosture(clip.frames[1]), Joint::kKneeRight, Joint::kAnkleRight),
              {0, 0, -1});
}

TEST_F(AcclaimTest, UsesTheSkeletonWhoseNameIsAPrefix) {
  Write("HDM_bk.asf", TPoseAsf());
  Write("HDM_b.asf", "broken");
  Write("HDM_bk_01-02_03_120.amc", kHeader + kStanding);
  const auto clips = LoadMocap({folder_.path().string()});
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].subject, "bk");
}

TEST_F(AcclaimTest, DamagedMotionIsRefusedByFileAndLine) {
  EXPECT_NE(Refusal(kHeader + "1\nroot 0 15 0 0 0\n").find("05_01.amc: line 5: expected 6 numbers"),
            std::string::npos);
  EXPECT_NE(Refusal(kHeader + "1\ntail 0 0 0\n").find("expected a bone of"), std::string::npos);
  EXPECT_NE(Refusal(kHeader + "1\nroot 0 15 0 0 x 0\n").find("found 'x'"), std::string::npos);
  EXPECT_NE(Refusal(kHeader + "2\nroot 0 15 0 0 0 0\n1\nroot 0 15 0 0 0 0\n")
                .find("line 6: expected the next frame number"),
            std::string::npos);
  EXPECT_NE(Refusal(kHeader + "1\n2\n").find("expected the bones of a frame"), std::string::npos);
  EXPECT_NE(Refusal(kHeader).find("expected a frame number, found the end"), std::string::npos);
}

TEST_F(AcclaimTest, DamagedSkeletonsAreRefusedByFileAndLine) {
  const auto damaged = [&](const std::string& cut, const std::string& instead) {
    std::string asf = TPoseAsf();
    asf.replace(asf.find(cut), cut.size(), instead);
    return Refusal(kHeader + kStanding, asf);
  };
  EXPECT_NE(damaged("angle deg", "angle grad").find("05.asf: line 7: expected angle deg or rad"),
            std::string::npos);
  EXPECT_NE(damaged("dof rx ry rz", "dof rx ry rw").find("found 'rw'"), std::string::npos);
  EXPECT_NE(damaged("0 0 0 XYZ", "0 0 0 XYW").find("axes such as XYZ"), std::string::npos);
  EXPECT_NE(damaged("name upperback", "name lowerback").find("every bone once"), std::string::npos);
  EXPECT_NE(damaged("    root lowerback", "    root nobody").find("a bone of :bonedata"),
            std::string::npos);
  EXPECT_NE(damaged("    root lowerback ", "    root ").find("to hang on the root"),
            std::string::npos);
  EXPECT_NE(damaged(":hierarchy", ":documentation").find("a section :hierarchy"),
            std::string::npos);
  EXPECT_NE(damaged("length 0.45", "length 0").find("a length scale above 0"), std::string::npos);
  EXPECT_NE(damaged("order TX TY TZ RX RY RZ", "order").find("expected 0 numbers"),
            std::string::npos);
}

// A frame of twenty bytes stands for the thousands of numbers that stay as they were.
TEST_F(AcclaimTest, FramesTimesDegreesOfFreedomAreBounded) {
  std::string bones, names, frames;
  for (int b = 0; b < 1900; ++b) {
    const std::string name = "extra" + std::to_string(b);
    names += " " + name;
    bones += "  begin\n    id " + std::to_string(100 + b) + "\n    name " + name +
             "\n    direction 0 1 0\n    length 1\n    axis 0 0 0 XYZ\n    dof rx ry rz\n  end\n";
  }
  for (int f = 1; f < 12000; ++f) frames += std::to_string(f) + "\nroot 0 15 0 0 0 0\n";
  std::string asf = TPoseAsf();
  asf.insert(asf.find(":hierarchy"), bones);
  asf.insert(asf.find("root lowerback") + 4, names);
  EXPECT_EQ(
      Refusal(kHeader + frames, asf),
      "05_01.amc: expected at most 67108864 numbers (frames x degrees of freedom), found more");
}

TEST_F(AcclaimTest, EveryTruncationIsRefusedOrReadWithoutCrashing) {
  const std::string asf = TPoseAsf();
  for (size_t length = 0; length < asf.size(); length += 7) {
    try {
      ParseAsf(asf.substr(0, length), "cut.asf");
    } catch (const InputError&) {
    }
  }
  EXPECT_THROW(ParseAsf(asf.substr(0, asf.size() / 2), "cut.asf"), InputError);
}

TEST_F(AcclaimTest, AMotionWithoutItsSkeletonIsRefused) {
  Write("lonely.amc", kHeader + kStanding);
  EXPECT_THROW(LoadMocap({folder_.path().string()}), InputError);
}

}  // namespace
}  // namespace ossa::recon
