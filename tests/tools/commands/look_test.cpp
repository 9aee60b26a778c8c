// `ossa look` from the outside: it learns from rendered people, and track looks with what it made.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "forest/forest.h"
#include "recon/body/body_model.h"
#include "recon/normalise.h"
#include "recon/refine/bone_measure.h"
#include "recon/refine/close_look.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/learning/look_examples.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

std::string TextOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void RenderPeople(const std::string& folder) {
  const auto run = RunOssa({"render", "--mocap", "authored", "--out", folder, "--frames", "150",
                            "--size", "160x120", "--format", "packed", "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
}

TEST(LookCommand, LearnsTheSameForAnyThreadsAndTrackLooksWithIt) {
  if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const std::string people = folder / "people", clip = folder / "clip";
  RenderPeople(people);
  const auto learn = [&](const char* threads, const std::string& out) {
    const auto run = RunOssa({"look", people, "--out", out, "--hidden", "4", "--epochs", "1",
                              "--threads", threads, "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return TextOf(out);
  };
  const std::string look = folder / "a.ossalook";
  EXPECT_EQ(learn("1", look), learn("3", folder / "b.ossalook"));
  EXPECT_GE(recon::CloseLook::Load(look).people, 128U);
  EXPECT_EQ(recon::CloseLook::Load(look).glances.at(0)[0].layers.at(0).bias.size(), 4);
  EXPECT_EQ(recon::CloseLook::Load(look).glances.at(0)[0].layers.at(1).bias.size(), 2);
  const auto info = RunOssa({"info", look});
  EXPECT_NE(
      info.out.find("close look at a forest's joints, 1 glance of 12 networks, learned from "),
      std::string::npos)
      << info.out << info.err;

  const std::string twice = folder / "c.ossalook";
  const auto again = RunOssa({"look", people, "--after", look, "--out", twice, "--hidden", "4",
                              "--epochs", "1", "--quiet"});
  EXPECT_EQ(again.exit_status, 0) << again.err;
  const auto both = recon::CloseLook::Load(twice);
  ASSERT_EQ(both.glances.size(), 2U);
  EXPECT_NE(RunOssa({"info", twice}).out.find("2 glances of 12 networks, the last made learned"),
            std::string::npos);
  const auto first_weights = [](const recon::Glance& glance) { return glance[3].layers[0].weight; };
  EXPECT_EQ(first_weights(both.glances[0]), first_weights(recon::CloseLook::Load(look).glances[0]));
  EXPECT_NE(first_weights(both.glances[0]), first_weights(both.glances[1]));

  const auto measure = [&](const char* threads, const std::string& out) {
    const auto run = RunOssa({"look", people, "--after", look, "--bones", "--out", out, "--hidden",
                              "4", "--epochs", "1", "--threads", threads, "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return TextOf(out);
  };
  const std::string bones = folder / "bones.ossalook";
  EXPECT_EQ(measure("1", bones), measure("3", folder / "bones3.ossalook"));
  const auto measured = RunOssa({"info", bones});
  EXPECT_NE(measured.out.find("1 glance of 12 networks, learned from "), std::string::npos)
      << measured.out;
  EXPECT_NE(measured.out.find("a measure of 11 bones"), std::string::npos) << measured.out;

  const auto tell = [&](const char* threads, const std::string& out) {
    const auto run = RunOssa({"look", people, "--after", bones, "--out", out, "--hidden", "4",
                              "--epochs", "1", "--threads", threads, "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return TextOf(out);
  };
  const std::string told = folder / "told.ossalook";
  EXPECT_EQ(tell("1", told), tell("3", folder / "told3.ossalook"));
  EXPECT_EQ(recon::CloseLook::Load(told).glances.size(), 1U);
  EXPECT_EQ(recon::CloseLook::Load(told).told.size(), 1U);
  EXPECT_NE(RunOssa({"info", told}).out.find("; 1 glance told of them"), std::string::npos);
  const auto late = RunOssa(
      {"look", people, "--after", told, "--bones", "--out", folder / "late.ossalook", "--quiet"});
  EXPECT_EQ(late.exit_status, 1);
  EXPECT_EQ(test::LineCount(late.err), 1) << late.err;

  ASSERT_EQ(RunOssa({"render", "--mocap", "authored", "--out", clip, "--frames", "5", "--sequence",
                     "--view", "front", "--size", "160x120", "--quiet"})
                .exit_status,
            0);
  const auto track = [&](const std::string& posture, const std::string& with) {
    const std::string out = folder / "joints.jsonl";
    const auto run =
        RunOssa({"track", clip, "--out", out, "--posture", posture, "--look", with, "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return TextOf(out);
  };
  const std::string raw = track("raw", look);
  EXPECT_NE(raw.find("HipCenter"), std::string::npos);
  EXPECT_FALSE(raw == track("looked", look));
  const std::string unlike_best = folder / "none.jsonl";
  EXPECT_EQ(RunOssa({"track", clip, "--method", "none", "--posture", "looked", "--out", unlike_best,
                     "--quiet"})
                .exit_status,
            0);
  EXPECT_FALSE(raw == TextOf(unlike_best));  // the shipped look was taken
  const auto bad = RunOssa({"track", clip, "--out", folder / "x.jsonl", "--look", clip});
  EXPECT_EQ(bad.exit_status, 1);
  EXPECT_EQ(test::LineCount(bad.err), 1) << bad.err;
}

// Where the joints truly are, in camera space.
recon::Posture TruthOf(const tools::LookExample& example) {
  const recon::ProposedPerson& person = example.description;
  recon::Posture true_m;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Vector3d there_m = person.place.position_m[j] + example.offset_m[j].cast<double>();
    true_m.position_m[j] = person.frame_from_camera.transpose() * there_m + person.middle_m;
  }
  return true_m;
}

TEST(LookExamples, OfShiftedPlacesLeadToTheSameJoints) {
  if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const std::string people = folder / "people";
  RenderPeople(people);
  const auto model = forest::ReadForestModel(tracker::ShippedFile("body.ossa"));
  tools::CloseLookOptions options;
  options.shifted = 2;
  options.shift_m = 0.03;
  const tools::LookExamples found = tools::GatherLookExamples(model, {people}, options);
  ASSERT_EQ(found.all.size(), 3 * found.people);
  double squares_m2 = 0.0;
  for (size_t i = 0; i < found.all.size(); i += 3) {
    const recon::Posture true_m = TruthOf(found.all[i]);
    for (size_t copy = i + 1; copy < i + 3; ++copy) {
      const recon::Posture again_m = TruthOf(found.all[copy]);
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        EXPECT_LT((again_m.position_m[j] - true_m.position_m[j]).norm(), 1e-5) << i << ' ' << j;
        squares_m2 += (found.all[copy].offset_m[j] - found.all[i].offset_m[j]).squaredNorm();
      }
    }
  }
  const double axes = 3.0 * 2.0 * static_cast<double>(found.people * recon::kJointCount);
  EXPECT_NEAR(std::sqrt(squares_m2 / axes), options.shift_m, 0.002);
  options.shifted = 0;
  EXPECT_EQ(tools::GatherLookExamples(model, {people}, options).all.size(), found.people);
}

// Glances that say nothing, and bones that are the standard ones whoever it is.
recon::CloseLook StandardBones() {
  recon::CloseLook look;
  const auto silent = [](Eigen::Index inputs, Eigen::Index outputs) {
    recon::RectifiedNetwork network;
    network.input_mean = Eigen::VectorXf::Zero(inputs);
    network.input_scale = Eigen::VectorXf::Ones(inputs);
    network.layers = {{Eigen::MatrixXf::Zero(outputs, inputs), Eigen::VectorXf::Zero(outputs)}};
    return network;
  };
  look.glances.emplace_back().fill(silent(recon::kLookInputs, 3));
  look.bones = silent(recon::kBoneInputs, recon::kMeasuredBones.size());
  return look;
}

TEST(LookExamples, AreToldOfBonesBetweenTheTrueOnesAndThoseThatAreJudged) {
  if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const std::string people = folder / "people";
  RenderPeople(people);
  const auto model = forest::ReadForestModel(tracker::ShippedFile("body.ossa"));
  tools::CloseLookOptions options;
  options.after = StandardBones();
  const tools::LookExamples found = tools::GatherLookExamples(model, {people}, options);
  double least = 1.0, most = 0.0;
  for (const tools::LookExample& example : found.all) {
    double told_m2 = 0.0, judged_m2 = 0.0;  // along the way from the true ones
    for (size_t i = 1; i < recon::kJointCount; ++i) {
      const double off_m = recon::StandardBoneLengths()[i] - example.bones_m[i];
      told_m2 += off_m * (example.told_m[i] - example.bones_m[i]);
      judged_m2 += off_m * off_m;
    }
    const double left = told_m2 / judged_m2;
    least = std::min(least, left);
    most = std::max(most, left);
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LT(least, 0.6);
  EXPECT_LE(most, 1.0);
  EXPECT_GT(most, 0.9);
}

TEST(LookCommand, SaysWhatIsWrongInOneLine) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossalook";
  EXPECT_EQ(RunOssa({"look", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--out", folder / "x.ossagp"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--hidden", "1", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--shifted", "-1", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--shift", "nan", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--rate", "0", "--out", out}).exit_status, 2);
  const auto track = [&](const char* option, const char* with) {
    return RunOssa({"track", "/nonexistent", "--out", folder / "x.jsonl", "--posture", "looked",
                    option, with})
        .exit_status;
  };
  EXPECT_EQ(track("--look", "none"), 2);
  EXPECT_EQ(track("--model", "my.ossa"), 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--after", out, "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--bones", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"look", "/nonexistent", "--after", folder / "y.ossalook", "--bones", "--shift",
                     "0.01", "--out", out})
                .exit_status,
            2);
  const auto after = RunOssa({"look", "/nonexistent", "--after", "/no.ossalook", "--out", out});
  EXPECT_EQ(after.exit_status, 1);
  EXPECT_NE(after.err.find("/no.ossalook"), std::string::npos) << after.err;
  const auto run = RunOssa({"look", "/nonexistent", "--out", out});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("/nonexistent"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(LookCommand, HasNoGlanceMoreThanMayBe) {
  const test::TemporaryFolder folder;
  recon::CloseLook look;
  look.glances.resize(recon::CloseLook::kMostGlances);
  for (recon::Glance& glance : look.glances) {
    for (recon::RectifiedNetwork& network : glance) {
      network.input_mean = Eigen::VectorXf::Zero(recon::kLookInputs);
      network.input_scale = Eigen::VectorXf::Ones(recon::kLookInputs);
      network.layers = {{Eigen::MatrixXf::Zero(3, recon::kLookInputs), Eigen::VectorXf::Zero(3)}};
    }
  }
  const std::string most = folder / "most.ossalook";
  look.Save(most);
  const auto run =
      RunOssa({"look", "/nonexistent", "--after", most, "--out", folder / "x.ossalook"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find(most + ": expected less than 8 glances"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
}

}  // namespace
}  // namespace ossa::commands
