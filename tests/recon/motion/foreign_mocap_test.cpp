// Mocap of any studio retargeted to the standard body: the result stands like the source.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "recon/body/standard_body.h"
#include "recon/motion/bvh.h"
#include "recon/motion/mocap.h"
#include "tests/recon/motion/figure.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::FigureStyle;

const Eigen::Quaterniond kYToZ(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));

std::vector<MotionClip> Load(const FigureStyle& style, const MocapOptions& options = {}) {
  const ossa::test::TemporaryFolder folder;
  std::ofstream(folder / "x.bvh") << test::FigureBvh(style);
  return LoadMocap({folder / "x.bvh"}, options);
}

/// Largest distance of any joint in any frame, with both HipCenters at one position.
double FarthestApart_m(const MotionClip& a, const MotionClip& b) {
  double farthest_m = 0.0;
  for (size_t f = 0; f < a.frames.size(); ++f) {
    const Posture one = StandardPosture(a.frames[f]), other = StandardPosture(b.frames.at(f));
    for (size_t j = 0; j < kJointCount; ++j) {
      farthest_m = std::max(farthest_m, (one.position_m[j] - one.position_m[0] -
                                         other.position_m[j] + other.position_m[0])
                                            .norm());
    }
  }
  return farthest_m;
}

// Compared with the same motion in a file whose zero pose is a T-pose. Limb directions agree; trunk
// and feet, determined by positions only, differ by a few degrees.
TEST(ForeignMocap, ZeroAnglesWithoutAPoseAreRetargetedByPositions) {
  FigureStyle along_x;
  along_x.bones_along_x = true;
  const auto plain = Load({}), odd = Load(along_x);
  ASSERT_EQ(odd.size(), 1u);
  EXPECT_TRUE(odd[0].warnings.empty());
  EXPECT_LT(FarthestApart_m(plain[0], odd[0]), 0.08);
}

TEST(ForeignMocap, ZeroAnglesWithoutAPoseKeepTheBending) {
  FigureStyle along_x;
  along_x.bones_along_x = true;
  const MotionClip clip = Load(along_x)[0];
  const Posture posture = StandardPosture(clip.frames[7]);
  const auto places = test::FigurePlaces(7);
  for (const auto& [from, to, a, b] : {std::tuple{Joint::kShoulderLeft, Joint::kElbowLeft, 6, 7},
                                       std::tuple{Joint::kElbowLeft, Joint::kWristLeft, 7, 8},
                                       std::tuple{Joint::kElbowRight, Joint::kWristRight, 11, 12},
                                       std::tuple{Joint::kHipLeft, Joint::kKneeLeft, 13, 14},
                                       std::tuple{Joint::kKneeRight, Joint::kAnkleRight, 18, 19}}) {
    const Eigen::Vector3d ours = (posture[to] - posture[from]).normalized();
    const Eigen::Vector3d theirs =
        (places[static_cast<size_t>(b)] - places[static_cast<size_t>(a)]).normalized();
    EXPECT_GT(ours.dot(theirs), 0.9999) << NameOf(to);
  }
}

// The rest pose stands along z, the motion along y: exporters turn the root.
TEST(ForeignMocap, StandsUprightIfRestAndMotionHaveDifferentAxes) {
  FigureStyle style;
  style.joint_axes = kYToZ.conjugate();
  EXPECT_LT(FarthestApart_m(Load({})[0], Load(style)[0]), 1e-4);
}

TEST(ForeignMocap, StandsUprightIfRestAndMotionAreZUp) {
  FigureStyle style;
  style.joint_axes = kYToZ.conjugate();
  style.file_from_world = kYToZ;
  EXPECT_LT(FarthestApart_m(Load({})[0], Load(style)[0]), 1e-4);
}

TEST(ForeignMocap, TwoRootsAreTwoClips) {
  const ossa::test::TemporaryFolder folder;
  std::string text = "HIERARCHY\n" + test::FigureHierarchy() + test::FigureHierarchy() +
                     "MOTION\nFrames: 3\nFrame Time: 0.0333333\n";
  for (size_t f = 0; f < 2; ++f) text += test::FigureRow(f) + " " + test::FigureRow(f) + "\n";
  std::ofstream(folder / "x.bvh") << text;
  const auto clips = LoadMocap({folder / "x.bvh"});
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].name, "x");
  EXPECT_EQ(clips[1].name, "x_2");
  ASSERT_EQ(clips[0].warnings.size(), 1u);
  EXPECT_NE(clips[0].warnings[0].find("says 3 frames, the file has 2"), std::string::npos);
  EXPECT_LT(FarthestApart_m(clips[0], clips[1]), 1e-12);
}

TEST(ForeignMocap, PropsAreIgnoredWithAWarning) {
  const ossa::test::TemporaryFolder folder;
  std::ofstream(folder / "x.bvh")
      << "HIERARCHY\nROOT sword {\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n}\n"
      << test::FigureHierarchy() << "MOTION\nFrames: 1\nFrame Time: 0.0333333\n7 "
      << test::FigureRow(0) << "\n";
  const auto clips = LoadMocap({folder / "x.bvh"});
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_EQ(clips[0].name, "x");
  EXPECT_LT(FarthestApart_m(clips[0], Load({.frames = 1})[0]), 1e-9);
  ASSERT_EQ(clips[0].warnings.size(), 1u);
  EXPECT_NE(clips[0].warnings[0].find("x.bvh: the root 'sword' is ignored: joint names of no"),
            std::string::npos)
      << clips[0].warnings[0];
}

TEST(ForeignMocap, SecondPersonWithoutChannelsIsIgnored) {
  const ossa::test::TemporaryFolder folder;
  std::string still = test::FigureHierarchy();
  for (size_t at = still.find("CHANNELS"); at != std::string::npos;
       at = still.find("CHANNELS", at + 1))
    still.replace(at, still.find('\n', at) - at, "CHANNELS 0");
  std::ofstream(folder / "x.bvh") << "HIERARCHY\n"
                                  << test::FigureHierarchy() << still
                                  << "MOTION\nFrames: 1\nFrame Time: 0.0333333\n"
                                  << test::FigureRow(0) << "\n";
  const auto clips = LoadMocap({folder / "x.bvh"});
  ASSERT_EQ(clips.size(), 1u);
  EXPECT_NE(clips[0].warnings.at(0).find("expected channels of the root 'Hips'"),
            std::string::npos);
  const auto skeletons = BvhToSkeleton(ReadBvh(folder / "x.bvh"), "x.bvh");
  EXPECT_EQ(skeletons.frames.at(0).bodies.size(), 1u);
}

// macOS stores such files beside the actual ones.
TEST(ForeignMocap, HiddenFilesAreIgnored) {
  const ossa::test::TemporaryFolder folder;
  std::ofstream(folder / "x.bvh") << test::FigureBvh();
  std::ofstream(folder / "._x.bvh") << "Mac OS X";
  EXPECT_EQ(LoadMocap({folder.path().string()}).size(), 1u);
}

TEST(ForeignMocap, UnusedMappingGivesAWarning) {
  const ossa::test::TemporaryFolder folder;
  std::string all = "Hips = Hips\nSpine = Spine\n";
  for (const std::string side : {"Left", "Right"}) {
    for (const char* bone : {"Arm", "ForeArm", "UpLeg", "Leg", "Foot"}) {
      all.append(side).append(bone).append(" = ").append(side).append(bone).append("\n");
    }
  }
  const auto warnings = [&](const std::string& mapping) {
    std::ofstream(folder / "names.txt") << mapping;
    MocapOptions options;
    options.mapping_file = folder / "names.txt";
    return Load({}, options).at(0).warnings;
  };
  EXPECT_TRUE(warnings(all).empty());
  EXPECT_NE(warnings("LeftArm = Robot_LeftArm\n").at(0).find("names.txt: is not used"),
            std::string::npos);
}

// Interpolated frames would take gigabytes.
TEST(ForeignMocap, FrameRateInPlaceOfFrameTimeIsRefused) {
  const ossa::test::TemporaryFolder folder;
  std::string text = test::FigureBvh({.frames = 700});
  text.replace(text.find("0.0333333"), 9, "60");
  std::ofstream(folder / "x.bvh") << text;
  ossa::test::ExpectRefused([&] { LoadMocap({folder / "x.bvh"}); },
                            "x.bvh: expected a motion of at most 10 hours, found 11.65 hours: 700 "
                            "frames of 60 s");
}

// With a wrong mapping (a trunk that rotates like a hand) the result disagrees with the source.
TEST(ForeignMocap, RetargetingThatDoesNotStandIsRefused) {
  const ossa::test::TemporaryFolder folder;
  std::ofstream(folder / "names.txt")
      << "Hips = LeftHand\nSpine = LeftHand\nNeck = Neck\nHead = Head\nLeftArm = LeftArm\n"
         "LeftForeArm = LeftForeArm\nRightArm = RightArm\nRightForeArm = RightForeArm\n"
         "LeftUpLeg = LeftUpLeg\nLeftLeg = LeftLeg\nLeftFoot = LeftFoot\nRightUpLeg = RightUpLeg\n"
         "RightLeg = RightLeg\nRightFoot = RightFoot\n";
  MocapOptions options;
  options.mapping_file = folder / "names.txt";
  ossa::test::ExpectRefused([&] { Load({}, options); }, "x.bvh: on the body the trunk would lie");
}

// People of another corpus, whose bones lie along x, with and without their mapping file.
TEST(ForeignMocap, BandaiNamcoClipsStandUpright) {
  const auto folder = ossa::test::SharedFolder() / "mocap/bandai_validation";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  MocapOptions mapped;
  mapped.mapping_file = folder / "mapping.txt";
  for (const char* name :
       {"dataset-1_walk_giant_001.bvh", "dataset-2_wave-both-hands_normal_001.bvh",
        "dataset-1_bow_normal_001.bvh"}) {
    const auto clip = LoadMocap({folder / name}).at(0);
    EXPECT_LT(FarthestApart_m(clip, LoadMocap({folder / name}, mapped).at(0)), 0.02) << name;
    double upright = 0.0, lowest_m = 1e9;
    for (const RigPose& frame : clip.frames) {
      const Posture p = StandardPosture(frame);
      upright += (p[Joint::kHead] - p[Joint::kHipCenter]).normalized().y() /
                 static_cast<double>(clip.frames.size());
      lowest_m = std::min({lowest_m, p[Joint::kAnkleLeft].y(), p[Joint::kAnkleRight].y()});
    }
    EXPECT_GT(upright, 0.85) << name;
    EXPECT_GT(lowest_m, 0.0) << name;
    EXPECT_LT(lowest_m, 0.12) << name;
  }
}

TEST(ForeignMocap, AllBandaiNamcoClipsAreRead) {
  const auto folder = ossa::test::SharedFolder() / "mocap/bandai_validation";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files += entry.path().extension() == ".bvh" ? 1 : 0;
  }
  const auto clips = LoadMocap({folder.string()});
  EXPECT_EQ(clips.size(), files);
  for (const MotionClip& clip : clips) EXPECT_TRUE(clip.warnings.empty()) << clip.name;
}

}  // namespace
}  // namespace ossa::recon
