#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "recon/files/skeleton_io.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

using recon::kJointCount;
using test::RunOssa;

/// Two seconds of a moving person on a floor, every joint tracked.
recon::SkeletonSequence Recording() {
  recon::SkeletonSequence sequence;
  for (int f = 0; f < 60; ++f) {
    recon::SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    frame.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.9);
    const auto posture = recon::test::InFrontOfCamera(recon::test::Motion(frame.time_s));
    recon::BodyRecord body;
    body.id = 3;
    for (size_t i = 0; i < kJointCount; ++i) {
      body.joints[i].emplace().position_m = posture.position_m[i];
    }
    frame.bodies.push_back(body);
    sequence.frames.push_back(frame);
  }
  return sequence;
}

class ReconstructCommand : public testing::Test {
 protected:
  ReconstructCommand() { recon::WriteSkeletons(in_, Recording()); }
  recon::SkeletonSequence Made(std::vector<std::string> options, const char* name = "out.jsonl") {
    const std::string out = folder_ / name;
    std::vector<std::string> arguments = {"reconstruct", in_, "--out", out, "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto run = RunOssa(arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return recon::ReadSkeletons(out);
  }
  test::TemporaryFolder folder_;
  std::string in_ = folder_ / "in.jsonl";
};

double BoneDrift(const recon::SkeletonSequence& sequence) {
  double worst = 0.0;
  recon::BoneLengths first{};
  for (const auto& frame : sequence.frames) {
    const auto lengths =
        recon::MeasureBoneLengths(recon::ToTrackedPosture(frame.bodies.at(0)).posture);
    if (&frame == &sequence.frames.front()) first = lengths;
    for (size_t i = 1; i < kJointCount; ++i) {
      worst = std::max(worst, std::abs(lengths[i] / first[i] - 1.0));
    }
  }
  return worst;
}

double MeanDistance(const recon::SkeletonSequence& a, const recon::SkeletonSequence& b) {
  double sum = 0.0;
  for (size_t f = 0; f < a.frames.size(); ++f) {
    for (size_t i = 0; i < kJointCount; ++i) {
      sum += (a.frames[f].bodies.at(0).joints[i]->position_m -
              b.frames[f].bodies.at(0).joints[i]->position_m)
                 .norm();
    }
  }
  return sum / static_cast<double>(a.frames.size() * kJointCount);
}

/// Largest angle, radians, between the hinge axis (the forearm's x) and its first direction, both
/// relative to the upper arm.
double ElbowAxisWander(const recon::SkeletonSequence& sequence) {
  double worst = 0.0;
  std::optional<Eigen::Vector3d> first;
  for (const auto& frame : sequence.frames) {
    const auto& joints = frame.bodies.at(0).joints;
    const Eigen::Vector3d axis =
        joints[5]->orientation->conjugate() * (*joints[6]->orientation * Eigen::Vector3d::UnitX());
    if (!first) first = axis;
    worst = std::max(worst, std::acos(std::clamp(axis.dot(*first), -1.0, 1.0)));
  }
  return worst;
}

/// The recording as a Kinect v2's: LabanotationSuite's table of ticks and x y z state of 25 joints.
void WriteKinectV2(const std::string& path, const recon::SkeletonSequence& sequence) {
  std::ofstream file(path);
  for (const auto& frame : sequence.frames) {
    file << static_cast<int64_t>(frame.time_s * 1e7) << ',';
    for (size_t j = 0; j < 25; ++j) {
      // Its first twenty are ours but for the neck; then the shoulders' centre, hand tips, thumbs.
      const size_t ours = j < kJointCount ? j : j == 20 ? 2 : j < 23 ? 7 : 11;
      const auto& p = frame.bodies.at(0).joints[ours]->position_m;
      file << p.x() << ',' << p.y() << ',' << p.z() << ",2,";
    }
    file << '\n';
  }
}

TEST_F(ReconstructCommand, CorrectsKnownErrorsOfAKinectAndReportsIt) {
  const std::string in = folder_ / "kinect.csv", out = folder_ / "out.jsonl";
  WriteKinectV2(in, Recording());
  const auto corrected = RunOssa({"reconstruct", in, "--out", out});
  ASSERT_EQ(corrected.exit_status, 0) << corrected.err;
  EXPECT_NE(corrected.err.find("kinect_v2.ossagp"), std::string::npos) << corrected.err;
  const auto with = recon::ReadSkeletons(out);
  const auto left = RunOssa({"reconstruct", in, "--out", out, "--learned", "none"});
  ASSERT_EQ(left.exit_status, 0) << left.err;
  EXPECT_EQ(left.err.find("kinect_v2.ossagp"), std::string::npos) << left.err;
  const double moved_m = MeanDistance(with, recon::ReadSkeletons(out));
  EXPECT_GT(moved_m, 0.005);  // a Kinect's joints are 2 to 4 cm off, by definition already
  EXPECT_LT(moved_m, 0.1);
  EXPECT_LT(BoneDrift(with), 0.001);
}

TEST_F(ReconstructCommand, CorrectsKnownErrorsOfRefinedJointsAndReportsIt) {
  const std::string in = folder_ / "looked.jsonl", out = folder_ / "out.jsonl";
  auto looked = Recording();
  for (auto& frame : looked.frames) frame.bodies[0].bones_m = recon::StandardBoneLengths();
  recon::WriteSkeletons(in, looked);
  EXPECT_EQ(recon::ReadSkeletons(in).sensor, recon::kRefinedJoints);
  const auto corrected = RunOssa({"reconstruct", in, "--out", out});
  ASSERT_EQ(corrected.exit_status, 0) << corrected.err;
  EXPECT_NE(corrected.err.find("body.ossagp"), std::string::npos) << corrected.err;
  const auto with = recon::ReadSkeletons(out);
  EXPECT_EQ(with.sensor, "");  // the output is no longer of a refinement
  const auto left = RunOssa({"reconstruct", in, "--out", out, "--learned", "none"});
  ASSERT_EQ(left.exit_status, 0) << left.err;
  EXPECT_EQ(left.err.find("body.ossagp"), std::string::npos) << left.err;
  const double moved_m = MeanDistance(with, recon::ReadSkeletons(out));
  EXPECT_GT(moved_m, 1e-4);  // the mean error of refined joints is millimetres
  EXPECT_LT(moved_m, 0.05);
}

// An inferred joint of a refinement is the mean of its distribution; one of a sensor is on the
// surface of the occluder.
TEST_F(ReconstructCommand, TrustsInferredJointsOfARefinementMore) {
  const std::string in = folder_ / "guessed.jsonl", out = folder_ / "out.jsonl";
  const auto hand = recon::Index(recon::Joint::kHandLeft);
  const auto moved_m = [&](bool is_refined) {
    auto guessed = Recording();
    for (auto& frame : guessed.frames) {
      recon::BodyRecord& body = frame.bodies[0];
      if (is_refined) body.bones_m = recon::StandardBoneLengths();
      for (size_t i = hand - 1; i <= hand; ++i) {  // with the wrist
        body.joints[i]->position_m.z() -= 0.1;
        body.joints[i]->state = recon::TrackingState::kInferred;
        body.joints[i]->confidence = 0.25;
      }
    }
    recon::WriteSkeletons(in, guessed);
    EXPECT_EQ(
        RunOssa({"reconstruct", in, "--out", out, "--learned", "none", "--quiet"}).exit_status, 0);
    double sum_m = 0.0;
    const auto made = recon::ReadSkeletons(out);
    for (size_t f = 0; f < made.frames.size(); ++f) {
      const auto& was = guessed.frames[f].bodies[0].joints[hand]->position_m;
      sum_m += (made.frames[f].bodies.at(0).joints[hand]->position_m - was).norm();
    }
    return sum_m / static_cast<double>(made.frames.size());
  };
  EXPECT_LT(moved_m(true), 0.8 * moved_m(false));
}

TEST_F(ReconstructCommand, CorrectsNothingForAnUnknownSensor) {
  const auto run = RunOssa({"reconstruct", in_, "--out", folder_ / "out.jsonl"});
  EXPECT_EQ(run.err.find("ossagp"), std::string::npos) << run.err;
}

TEST_F(ReconstructCommand, CompletesEveryFrame) {
  const auto made = Made({});
  ASSERT_EQ(made.frames.size(), 60u);
  EXPECT_EQ(made.frames.back().bodies.at(0).id, 3);
  // Without error and noise only smoothing moves joints: it lags by about a centimetre.
  EXPECT_LT(MeanDistance(made, Recording()), 0.03);
}

// It counted 180 of 180: each of the three passes over a frame.
TEST_F(ReconstructCommand, CountsAFrameOnceOverSeveralPasses) {
  const auto run = RunOssa({"reconstruct", in_, "--out", folder_ / "out.jsonl", "--bones",
                            "recording", "--physics", "on"});
  EXPECT_NE(run.err.find("reconstruct: 60 of 60"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("180"), std::string::npos) << run.err;
}

// Users who compare methods give all of them the same files.
TEST_F(ReconstructCommand, ReportsFilesThatTheMethodDoesNotRead) {
  const auto with = [&](const char* method, const char* option) {
    return RunOssa({"reconstruct", in_, "--out", folder_ / "out.jsonl", "--quiet", "--method",
                    method, option, "/no.file"});
  };
  for (const char* option : {"--database", "--prior", "--learned"}) {
    const auto run = RunOssa({"reconstruct", in_, "--out", folder_ / "out.jsonl", "--method",
                              "kalman", option, "/no.file"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_NE(run.err.find(std::string("ossa: ") + option + " is not read by --method kalman\n"),
              std::string::npos)
        << run.err;
  }
  EXPECT_EQ(with("kalman", "--database").err, "");
  EXPECT_EQ(with("butterworth", "--learned").exit_status, 0);
  EXPECT_EQ(with("shum-2013", "--database").exit_status, 1);
  EXPECT_EQ(with("best", "--prior").exit_status, 1);
}

TEST_F(ReconstructCommand, AcceptsTheOptionsOfTheMethod) {
  for (const char* method : {"shum-2013", "plantard-2016"}) {
    Made({"--method", method, "--solver", "ceres", "--neighbours", "20", "--dimensions", "8",
          "--steps", "4", "--weights", "1,1,1,1", "--no-reliability", "--keep-reliable"});
  }
  Made({"--method", "shum-2013", "--extend", "--samples", "9", "--learned", "none"});
  Made({"--method", "butterworth", "--cutoff", "3", "--learned", "none"});
}

TEST_F(ReconstructCommand, PhysicsKeepsBoneLengthsConstantAndWritesOrientations) {
  for (const char* control : {"pd", "motor"}) {
    const auto made = Made({"--method", "none", "--physics", "on", "--control", control});
    ASSERT_EQ(made.frames.size(), 60u);
    // The files carry a tenth of a micrometre, the shortest bone is 7 cm.
    EXPECT_LT(BoneDrift(made), 1e-4) << control;
    // A character moves as masses do, a few centimetres behind its target, and is nowhere else.
    const double off_m = MeanDistance(made, Recording());
    EXPECT_GT(off_m, 1e-4) << control;
    EXPECT_LT(off_m, 0.1) << control;
    EXPECT_TRUE(made.frames.back().bodies.at(0).joints[5]->orientation.has_value());
  }
}

TEST_F(ReconstructCommand, HingesAndJointLimitsChangeTheMotionOfTheCharacter) {
  // A head that hangs down the back, beyond its limits.
  auto recording = Recording();
  for (auto& frame : recording.frames) {
    auto& joints = frame.bodies[0].joints;
    const Eigen::Vector3d neck = joints[2]->position_m - joints[1]->position_m;
    joints[3]->position_m = joints[2]->position_m - 0.15 * neck.normalized() +
                            0.12 * neck.cross(Eigen::Vector3d::UnitX()).normalized();
  }
  recon::WriteSkeletons(in_, recording);
  const auto plain = Made({"--method", "none", "--physics", "on"}, "plain.jsonl");
  const auto limited = Made({"--method", "none", "--physics", "on", "--joint-limits"});
  EXPECT_GT(MeanDistance(limited, plain), 1e-3);
  EXPECT_LT(BoneDrift(limited), 1e-4);
  const auto hinged = Made({"--method", "none", "--physics", "on", "--hinges"}, "hinged.jsonl");
  EXPECT_LT(ElbowAxisWander(hinged), 0.05);  // 3 degrees: what the iterative solver leaves
  EXPECT_LT(ElbowAxisWander(hinged), 0.5 * ElbowAxisWander(plain));
  EXPECT_LT(BoneDrift(hinged), 1e-4);
}

// The first frame has a forearm 15 cm too long, which all others keep unless its length is measured
// over the whole recording.
TEST_F(ReconstructCommand, BonesOfTheRecordingAreEqualInEveryFrame) {
  const auto truth = Recording();
  auto recording = truth;
  for (const size_t joint : {size_t{6}, size_t{7}})
    recording.frames[0].bodies[0].joints[joint]->position_m.y() -= 0.15;
  recon::WriteSkeletons(in_, recording);
  const auto forearm_m = [](const recon::SkeletonSequence& sequence) {
    return recon::MeasureBoneLengths(
        recon::ToTrackedPosture(sequence.frames.front().bodies.at(0)).posture)[6];
  };
  const auto so_far = Made({"--bones", "so-far"}, "a.jsonl");
  EXPECT_EQ(MeanDistance(Made({}, "b.jsonl"), so_far), 0.0);
  EXPECT_GT(forearm_m(so_far), forearm_m(truth) + 0.04);
  const auto whole = Made({"--bones", "recording"});
  EXPECT_NEAR(forearm_m(whole), forearm_m(truth), 0.02);
  EXPECT_LT(BoneDrift(whole), 1e-3);
  EXPECT_LT(BoneDrift(Made({"--bones", "recording", "--physics", "on"}, "c.jsonl")), 1e-3);
}

TEST_F(ReconstructCommand, WritesAFolderForAFolder) {
  const std::string clips = folder_ / "clips", out = folder_ / "made";
  std::filesystem::create_directories(clips);
  recon::WriteSkeletons(clips + "/a.jsonl", Recording());
  EXPECT_EQ(RunOssa({"reconstruct", clips, "--out", out, "--quiet"}).exit_status, 0);
  EXPECT_EQ(recon::ReadSkeletons(out + "/a.jsonl").frames.size(), 60U);
  recon::WriteSkeletons(clips + "/b.jsonl", Recording());
  const auto run = RunOssa({"reconstruct", clips, "--out", folder_ / "x.bvh", "--quiet"});
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_NE(run.err.find("expected a folder for 2 recordings"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.bvh"));
}

TEST_F(ReconstructCommand, PhysicsOffIsTheDefault) {
  EXPECT_EQ(MeanDistance(Made({}, "a.jsonl"), Made({"--physics", "off"}, "b.jsonl")), 0.0);
}

TEST_F(ReconstructCommand, PhysicsFillsJointsThatAFileLacks) {
  auto recording = Recording();
  for (auto& frame : recording.frames) frame.bodies[0].joints[11].reset();
  recon::WriteSkeletons(in_, recording);
  const auto made = Made({"--method", "butterworth", "--physics", "on"});
  const auto& hand = made.frames.back().bodies.at(0).joints[11];
  ASSERT_TRUE(hand.has_value());
  EXPECT_TRUE(hand->position_m.allFinite());
  EXPECT_EQ(hand->state, recon::TrackingState::kInferred);
}

TEST_F(ReconstructCommand, TakesExtensionsInUpperCase) {
  const auto made = Made({"--method", "none", "--bvh-names", "vrm"}, "out.BVH");
  EXPECT_EQ(made.frames.size(), 60u);
}

// A .bvh has a fixed frame rate: gaps are filled at 30 frames a second.
TEST_F(ReconstructCommand, RefusesToFillAHugeGapInABvh) {
  auto recording = Recording();
  for (size_t f = 30; f < 33; ++f) {
    for (size_t later = f; later < 60; ++later) recording.frames[later].time_s += 80000.0;
  }
  recon::WriteSkeletons(in_, recording);
  const std::string out = folder_ / "out.bvh";
  const auto run = RunOssa({"reconstruct", in_, "--out", out, "--method", "none", "--quiet"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("out.bvh: expected a BVH of at most 512 MiB"), std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("the longest gap"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

// Whatever is said after '#', and whatever is in the folder's name.
TEST_F(ReconstructCommand, RefusesToOverwriteItsInput) {
  std::filesystem::create_directory(folder_ / "a#b");
  const std::string in = folder_ / "a#b/in.jsonl";
  recon::WriteSkeletons(in, Recording());
  const auto run = RunOssa({"reconstruct", in + "#observed", "--out", in, "--method", "none"});
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_NE(run.err.find(in + ": expected an output other than the inputs, found the input " + in),
            std::string::npos)
      << run.err;
}

struct BadReconstruct {
  const char* name;
  std::vector<std::string> arguments;
  int status;
  std::string named;
};

void PrintTo(const BadReconstruct& value, std::ostream* out) { *out << value.name; }

class BadReconstructUse : public testing::TestWithParam<BadReconstruct> {};

TEST_P(BadReconstructUse, IsReportedInOneLineThatNamesIt) {
  test::TemporaryFolder folder;
  const std::string in = folder / "in.jsonl";
  recon::WriteSkeletons(in, Recording());
  std::vector<std::string> arguments = {"reconstruct"};
  for (std::string argument : GetParam().arguments) {
    if (argument == "IN") argument = in;
    if (argument == "OUT") argument = folder / "out.jsonl";
    arguments.push_back(argument);
  }
  const auto run = RunOssa(arguments);
  EXPECT_EQ(run.exit_status, GetParam().status);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find(GetParam().named), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out.jsonl"));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadReconstructUse,
    testing::Values(
        BadReconstruct{"no_out", {"IN"}, 2, "--out"},
        BadReconstruct{"physics", {"IN", "--out", "OUT", "--physics", "maybe"}, 2, "--physics"},
        BadReconstruct{"physics_alone", {"IN", "--out", "OUT", "--physics"}, 2, "--physics"},
        BadReconstruct{"control", {"IN", "--out", "OUT", "--control", "magic"}, 2, "--control"},
        BadReconstruct{"hinges", {"IN", "--out", "OUT", "--hinges"}, 2, "--physics"},
        BadReconstruct{"limits", {"IN", "--out", "OUT", "--joint-limits"}, 2, "--physics"},
        BadReconstruct{"bones", {"IN", "--out", "OUT", "--bones", "mine"}, 2, "--bones"},
        BadReconstruct{"bones_of_a_filter",
                       {"IN", "--out", "OUT", "--bones", "recording", "--method", "holt"},
                       2,
                       "found holt"},
        BadReconstruct{"character_off",
                       {"IN", "--out", "OUT", "--physics", "off", "--control", "motor"},
                       2,
                       "expected --physics on"},
        BadReconstruct{"two_to_complete_by",
                       {"IN", "--out", "OUT", "--database", "a", "--prior", "b"},
                       2,
                       "one of them"},
        BadReconstruct{"solver_of_best",
                       {"IN", "--out", "OUT", "--solver", "ceres"},
                       2,
                       "--solver is not read by --method best: expected a method that does "
                       "(shum-2013, plantard-2016)"},
        BadReconstruct{"weights_of_zero",
                       {"IN", "--out", "OUT", "--method", "shum-2013", "--weights", "0,0,0,0"},
                       2,
                       "--weights: expected one above 0, found zeros"},
        BadReconstruct{"scene_without_physics",
                       {"IN", "--out", "OUT", "--physics", "off", "--scene", "s.toml"},
                       2,
                       "--physics off: expected no --scene with it"},
        BadReconstruct{"weights_of_best",
                       {"IN", "--out", "OUT", "--weights", "1,1,1,1"},
                       2,
                       "--weights is not read by --method best"},
        BadReconstruct{"flag_of_a_filter",
                       {"IN", "--out", "OUT", "--method", "holt", "--no-reliability"},
                       2,
                       "--no-reliability is not read"},
        BadReconstruct{"extended_graph",
                       {"IN", "--out", "OUT", "--method", "plantard-2016", "--extend"},
                       2,
                       "(shum-2013)"},
        BadReconstruct{"cutoff", {"IN", "--out", "OUT", "--cutoff", "6"}, 2, "(butterworth)"},
        BadReconstruct{
            "samples_of_ceres",
            {"IN", "--out", "OUT", "--method", "shum-2013", "--solver", "ceres", "--samples", "10"},
            2,
            "--samples is not read by --solver ceres"},
        BadReconstruct{"method", {"IN", "--out", "OUT", "--method", "guess"}, 2, "--method"},
        BadReconstruct{
            "nothing_learned", {"IN", "--out", "OUT", "--method", "full-gp"}, 2, "--learned"},
        BadReconstruct{"learned_none",
                       {"IN", "--out", "OUT", "--method", "exemplar", "--learned", "none"},
                       2,
                       "--learned"},
        BadReconstruct{"no_such_file", {"/no/such.jsonl", "--out", "OUT"}, 1, "/no/such.jsonl"},
        BadReconstruct{"learned", {"IN", "--out", "OUT", "--learned", "/no.gp"}, 1, "/no.gp"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace ossa
