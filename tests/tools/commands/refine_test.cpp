// `ossa refine` as a process: it learns from rendered people, and track refines joints with its
// output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "depth/base/checksummed_container.h"
#include "forest/forest.h"
#include "recon/body/body_model.h"
#include "recon/normalise.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/support/perceptrons.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/learning/refinement_examples.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

std::string TextOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void RenderPeople(const std::string& folder, const char* view = "front") {
  const auto run = RunOssa({"render", "--mocap", "authored", "--out", folder, "--frames", "150",
                            "--size", "160x120", "--view", view, "--format", "packed", "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
}

// A cascade of one stage that moves the head by `up_m` and nothing else, and estimates no bones.
recon::RefinementCascade HeadHigher(double up_m) {
  recon::RefinementCascade cascade;
  cascade.people = 1;
  cascade.stages.emplace_back().fill(test::SilentPerceptron({recon::kStageFeatures, 3}));
  const auto head =
      std::find(recon::kStageJoints.begin(), recon::kStageJoints.end(), recon::Joint::kHead);
  cascade.stages[0][static_cast<size_t>(head - recon::kStageJoints.begin())].layers[0].bias[1] =
      static_cast<float>(up_m / recon::RefinementCascade::kOffsets.step_m);
  return cascade;
}

// The same, with the standard bone lengths estimated for everybody.
recon::RefinementCascade StandardBones() {
  recon::RefinementCascade cascade = HeadHigher(0.0);
  cascade.measured = 1;
  cascade.bones = test::SilentPerceptron({recon::kBoneFeatures, recon::kEstimatedBones.size()});
  return cascade;
}

class RefineCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  }

  // Rendered people, the smallest training there is.
  const std::string& people() {
    if (people_.empty()) RenderPeople(people_ = folder_ / "people");
    return people_;
  }
  // Runs `ossa refine` on them with these options beside the fixed ones; returns the written bytes.
  std::string Learn(const std::string& out, std::vector<std::string> options,
                    const char* threads = "2") {
    std::vector<std::string> words = {"refine",   people(), "--out",     out,     "--hidden", "4",
                                      "--epochs", "1",      "--threads", threads, "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const auto run = RunOssa(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return TextOf(out);
  }
  std::string Saved(const char* name, const recon::RefinementCascade& cascade) {
    cascade.Save(folder_ / name);
    return folder_ / name;
  }
  // The output of track of a rendered clip with these options.
  std::string Track(std::vector<std::string> options) {
    const std::string clip = folder_ / "clip", out = folder_ / "joints.jsonl";
    if (!std::filesystem::exists(clip)) {
      const auto made = RunOssa({"render", "--mocap", "authored", "--out", clip, "--frames", "5",
                                 "--sequence", "--view", "front", "--size", "160x120", "--quiet"});
      EXPECT_EQ(made.exit_status, 0) << made.err;
    }
    std::vector<std::string> words = {"track", clip, "--out", out, "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const auto run = RunOssa(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return TextOf(out);
  }

  const test::TemporaryFolder folder_;

 private:
  std::string people_;
};

using Cascade = recon::RefinementCascade;

TEST_F(RefineCommand, LearnsTheSameStageForAnyNumberOfThreads) {
  const std::string out = folder_ / "a.ossarefine";
  EXPECT_EQ(Learn(out, {}, "1"), Learn(folder_ / "b.ossarefine", {}, "3"));
  const Cascade learned = Cascade::Load(out);
  EXPECT_GE(learned.people, 128U);
  EXPECT_EQ(learned.stages.at(0)[0].layers.at(0).bias.size(), 4);
  EXPECT_EQ(learned.stages.at(0)[0].layers.at(1).bias.size(), 2);
  const auto info = RunOssa({"info", out});
  EXPECT_NE(
      info.out.find("refinement cascade for a forest's joints, 1 stage of 12 networks, learned "
                    "from "),
      std::string::npos)
      << info.out << info.err;
}

TEST_F(RefineCommand, LearnsAnOverheadCascadeWhenAllPeopleAreSeenFromAbove) {
  const std::string above = folder_ / "above", out = folder_ / "above.ossarefine";
  RenderPeople(above, "ceiling");
  const std::string forest = tracker::ShippedFile("body_ceiling.ossa");
  const auto learn = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "refine");
    words.insert(words.end(), {"--model", forest, "--out", out, "--hidden", "4", "--epochs", "1",
                               "--shifted", "0", "--quiet"});
    return RunOssa(words);
  };
  const auto run = learn({above});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_TRUE(Cascade::Load(out).from_above);
  EXPECT_NE(RunOssa({"info", out}).out.find(" people seen from the ceiling, "), std::string::npos);

  const auto mixed = learn({above, people()});
  EXPECT_EQ(mixed.exit_status, 1);
  EXPECT_EQ(test::LineCount(mixed.err), 1) << mixed.err;
  EXPECT_NE(mixed.err.find(people() + ": expected"), std::string::npos) << mixed.err;
  const std::string level = Saved("level.ossarefine", HeadHigher(0.0));
  const auto after = learn({above, "--after", level});
  EXPECT_EQ(after.exit_status, 1);
  EXPECT_EQ(test::LineCount(after.err), 1) << after.err;
  EXPECT_NE(after.err.find(level + ": learned on people seen by a level camera"), std::string::npos)
      << after.err;
}

TEST_F(RefineCommand, AddsAStageToTheStagesOfTheGivenFile) {
  const Cascade before = HeadHigher(0.02);
  const std::string out = folder_ / "twice.ossarefine";
  Learn(out, {"--after", Saved("once.ossarefine", before)});
  const Cascade both = Cascade::Load(out);
  ASSERT_EQ(both.stages.size(), 2U);
  for (size_t k = 0; k < recon::kStageJoints.size(); ++k) {
    EXPECT_EQ(both.stages[0][k].layers.size(), 1U);
    EXPECT_EQ(both.stages[1][k].layers.size(), 3U);
  }
  EXPECT_NE(RunOssa({"info", out}).out.find("2 stages of 12 networks, the last made learned"),
            std::string::npos);
}

TEST_F(RefineCommand, LearnsTheSameBonesForAnyNumberOfThreads) {
  const std::string after = Saved("once.ossarefine", HeadHigher(0.0));
  const std::string out = folder_ / "a.ossarefine";
  EXPECT_EQ(Learn(out, {"--after", after, "--bones"}, "1"),
            Learn(folder_ / "b.ossarefine", {"--after", after, "--bones"}, "3"));
  const auto info = RunOssa({"info", out});
  EXPECT_NE(info.out.find("an estimate of 11 bones"), std::string::npos) << info.out;
}

TEST_F(RefineCommand, LearnsTheSameBoneConditionedStageForAnyNumberOfThreads) {
  const std::string after = Saved("bones.ossarefine", StandardBones());
  const std::string out = folder_ / "a.ossarefine";
  EXPECT_EQ(Learn(out, {"--after", after}, "1"),
            Learn(folder_ / "b.ossarefine", {"--after", after}, "3"));
  EXPECT_EQ(Cascade::Load(out).stages.size(), 1U);
  EXPECT_EQ(Cascade::Load(out).bone_conditioned.size(), 1U);
  EXPECT_NE(RunOssa({"info", out}).out.find("; 1 bone-conditioned stage"), std::string::npos);
}

TEST_F(RefineCommand, WarnsWhenEarlierStagesBelongToAnotherForest) {
  const std::string first = folder_ / "first.ossarefine", out = folder_ / "two.ossarefine";
  Learn(first, {});
  const uint64_t forest = ReadContainerChecksum(tracker::ShippedFile("body.ossa"));
  EXPECT_EQ(Cascade::Load(first).forest_checksum, forest);
  const auto warning = [&](uint64_t learned_at) {
    Cascade cascade = Cascade::Load(first);
    cascade.forest_checksum = learned_at;
    const auto run = RunOssa({"refine", people(), "--after", Saved("before.ossarefine", cascade),
                              "--out", out, "--hidden", "4", "--epochs", "1", "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.err;
  };
  EXPECT_EQ(warning(forest), "");
  EXPECT_EQ(warning(0), "") << "an old file does not know";
  EXPECT_EQ(Cascade::Load(out).forest_checksum, 0U) << "nor does what was added to it";
  const std::string other = warning(forest + 1);
  EXPECT_NE(other.find("before.ossarefine: its stages were learned at the joints of another"),
            std::string::npos)
      << other;
  EXPECT_EQ(test::LineCount(other), 1) << other;
}

TEST_F(RefineCommand, RefusesToLearnBonesOnceAStageIsConditionedOnThem) {
  Cascade cascade = StandardBones();
  cascade.bone_conditioned.emplace_back().fill(
      test::SilentPerceptron({recon::kBoneConditionedFeatures, 3}));
  const auto run = RunOssa({"refine", "/nonexistent", "--after", Saved("late.ossarefine", cascade),
                            "--bones", "--out", folder_ / "x.ossarefine", "--quiet"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("expected no bone-conditioned stage, found 1"), std::string::npos);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
}

TEST_F(RefineCommand, WritesTheFileThatTrackRefinesJointsWith) {
  const std::string higher = Saved("higher.ossarefine", HeadHigher(0.1));
  const std::string raw = Track({"--posture", "raw", "--refinement", higher});
  EXPECT_NE(raw.find("HipCenter"), std::string::npos);
  EXPECT_FALSE(raw == Track({"--posture", "refined", "--refinement", higher}));
}

TEST_F(RefineCommand, TrackRefinesWithTheShippedCascadeByDefault) {
  const std::string raw = Track({"--method", "none", "--posture", "raw"});
  EXPECT_FALSE(raw == Track({"--method", "none", "--posture", "refined"}));  // by the shipped one
}

TEST_F(RefineCommand, OptionAndCommandNamesOfEarlierVersionsWork) {
  const std::string higher = Saved("higher.ossalook", HeadHigher(0.1));
  EXPECT_EQ(Track({"--posture", "looked", "--look", higher}),
            Track({"--posture", "refined", "--refinement", higher}));
  const auto run = RunOssa({"look", "/nonexistent", "--out", folder_ / "x.ossalook"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("/nonexistent"), std::string::npos) << run.err;
}

TEST_F(RefineCommand, TrackRefusesAFileOfAnotherKindInOneLine) {
  const auto bad = RunOssa({"track", "/nonexistent", "--out", folder_ / "x.jsonl", "--refinement",
                            Saved("a.ossarefine", HeadHigher(0.0)) + "/not"});
  EXPECT_EQ(bad.exit_status, 1);
  EXPECT_EQ(test::LineCount(bad.err), 1) << bad.err;
}

TEST_F(RefineCommand, TrackWarnsOfACascadeOfAnotherForest) {
  Cascade cascade = HeadHigher(0.1);
  const auto said = [&](uint64_t learned_at) {
    cascade.forest_checksum = learned_at;
    return RunOssa({"track", "/nonexistent", "--out", folder_ / "x.jsonl", "--refinement",
                    Saved("my.ossarefine", cascade)})
        .err;
  };
  const uint64_t forest = ReadContainerChecksum(tracker::ShippedFile("body.ossa"));
  const std::string fits = said(forest), other = said(forest + 1);
  EXPECT_EQ(fits.find("warning"), std::string::npos) << fits;
  EXPECT_NE(other.find("track: warning: "), std::string::npos) << other;
  EXPECT_NE(other.find("my.ossarefine: learned at the joints of another forest than "),
            std::string::npos)
      << other;
  EXPECT_EQ(test::LineCount(other), test::LineCount(fits) + 1) << other;
}

// The true joints, in camera space.
recon::Posture TruthOf(const tools::RefinementExample& example) {
  const recon::ProposedPerson& person = example.person;
  recon::Posture true_m;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Vector3d there_m =
        person.place.position_m[j] +
        recon::RefinementCascade::kOffsets.step_m * example.offset[j].cast<double>().transpose();
    true_m.position_m[j] = person.frame_from_camera.transpose() * there_m + person.middle_m;
  }
  return true_m;
}

TEST(RefinementExamples, OfShiftedStartsHaveTheSameTargets) {
  if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const std::string people = folder / "people";
  RenderPeople(people);
  const auto model = forest::ReadForestModel(tracker::ShippedFile("body.ossa"));
  tools::RefinementStageOptions options;
  options.shifted = 2;
  options.shift_m = 0.03;
  const tools::RefinementExamples found = tools::GatherRefinementExamples(model, {people}, options);
  ASSERT_EQ(found.all.size(), 3 * found.people);
  double squares_m2 = 0.0;
  for (size_t i = 0; i < found.all.size(); i += 3) {
    const recon::Posture true_m = TruthOf(found.all[i]);
    for (size_t copy = i + 1; copy < i + 3; ++copy) {
      const recon::Posture again_m = TruthOf(found.all[copy]);
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        EXPECT_LT((again_m.position_m[j] - true_m.position_m[j]).norm(), 1e-5) << i << ' ' << j;
        const double off =
            (found.all[copy].offset[j] - found.all[i].offset[j]).cast<double>().norm();
        squares_m2 += std::pow(recon::RefinementCascade::kOffsets.step_m * off, 2);
      }
    }
  }
  const double axes = 3.0 * 2.0 * static_cast<double>(found.people * recon::kJointCount);
  EXPECT_NEAR(std::sqrt(squares_m2 / axes), options.shift_m, 0.002);
  options.shifted = 0;
  EXPECT_EQ(tools::GatherRefinementExamples(model, {people}, options).all.size(), found.people);
}

TEST(RefinementExamples, InterpolateBonesBetweenTrueAndEstimated) {
  if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const std::string people = folder / "people";
  RenderPeople(people);
  const auto model = forest::ReadForestModel(tracker::ShippedFile("body.ossa"));
  tools::RefinementStageOptions options;
  options.after = StandardBones();
  const tools::RefinementExamples found = tools::GatherRefinementExamples(model, {people}, options);
  double least = 1.0, most = 0.0;
  for (const tools::RefinementExample& example : found.all) {
    double given_m2 = 0.0, estimated_m2 = 0.0;  // along the way from the true ones
    for (size_t i = 1; i < recon::kJointCount; ++i) {
      const double off_m = recon::StandardBoneLengths()[i] - example.bones_m[i];
      given_m2 += off_m * (example.given_bones_m[i] - example.bones_m[i]);
      estimated_m2 += off_m * off_m;
    }
    const double left = given_m2 / estimated_m2;
    least = std::min(least, left);
    most = std::max(most, left);
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LT(least, 0.6);
  EXPECT_LE(most, 1.0);
  EXPECT_GT(most, 0.9);
}

TEST(RefineCommandErrors, AreReportedInOneLine) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossarefine";
  EXPECT_EQ(RunOssa({"refine", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--out", folder / "x.ossagp"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--hidden", "1", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--shifted", "-1", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--shift", "nan", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--rate", "0", "--out", out}).exit_status, 2);
  const auto track = [&](const char* option, const char* with) {
    return RunOssa({"track", "/nonexistent", "--out", folder / "x.jsonl", "--posture", "refined",
                    option, with})
        .exit_status;
  };
  EXPECT_EQ(track("--refinement", "none"), 2);
  EXPECT_EQ(track("--model", "my.ossa"), 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--after", out, "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--bones", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"refine", "/nonexistent", "--after", folder / "y.ossarefine", "--bones",
                     "--shift", "0.01", "--out", out})
                .exit_status,
            2);
  const auto after = RunOssa({"refine", "/nonexistent", "--after", "/no.ossarefine", "--out", out});
  EXPECT_EQ(after.exit_status, 1);
  EXPECT_NE(after.err.find("/no.ossarefine"), std::string::npos) << after.err;
  const auto run = RunOssa({"refine", "/nonexistent", "--out", out});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("/nonexistent"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(RefineCommandErrors, TooManyStagesAreRefused) {
  const test::TemporaryFolder folder;
  recon::RefinementCascade cascade = HeadHigher(0.0);
  cascade.stages.resize(recon::RefinementCascade::kMaxStages, cascade.stages[0]);
  const std::string most = folder / "most.ossarefine";
  cascade.Save(most);
  const auto run =
      RunOssa({"refine", "/nonexistent", "--after", most, "--out", folder / "x.ossarefine"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find(most + ": expected less than 8 stages"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
}

}  // namespace
}  // namespace ossa::commands
