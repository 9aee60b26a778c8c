// Damaged or unsuitable data sets and models: one clear line each.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "forest/forest.h"
#include "recon/body/body_model.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::tests {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::RunOssa;

class BadDataSet : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: run tools/fetch_body";
    const CommandResult made = RunOssa({"render", "--mocap", "authored", "--out", data(),
                                        "--frames", "4", "--size", "96x72", "--quiet"});
    ASSERT_EQ(made.exit_status, 0) << made.err;
  }
  std::string data() const { return (folder_.path() / "data").string(); }
  std::string model() const { return (folder_.path() / "model.ossa").string(); }
  // Another data set, of 80 frames.
  std::string RenderEnoughForASecondStage() const {
    const std::string fresh = folder_ / "fresh";
    const CommandResult made = RunOssa({"render", "--mocap", "authored", "--out", fresh, "--frames",
                                        "80", "--size", "96x72", "--quiet"});
    EXPECT_EQ(made.exit_status, 0) << made.err;
    return fresh;
  }

  // One line that names `culprit`, and no model. (Data that is validated on itself is warned of.)
  void ExpectRefused(const std::string& culprit) const {
    const CommandResult result =
        RunOssa({"train", data(), "--out", model(), "--trees", "1", "--depth", "3", "--pixels",
                 "50", "--validation", data(), "--quiet"});
    EXPECT_EQ(result.exit_status, 1);
    const auto warning = result.err.starts_with("train: warning: ") ? 1 : 0;
    EXPECT_EQ(test::LineCount(result.err), 1 + warning) << result.err;
    EXPECT_NE(result.err.find(culprit), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(model()));
  }

  test::TemporaryFolder folder_;
};

TEST_F(BadDataSet, AMissingImageIsNamed) {
  fs::remove(fs::path(data()) / "depth" / "000002.png");
  ExpectRefused("000002.png");
}

// Writing the card failed at the end of the training.
TEST_F(BadDataSet, InvalidUtf8InOptionsIsReplacedOnTheCard) {
  const CommandResult result =
      RunOssa({"train", data(), "--out", model(), "--trees", "1", "--depth", "3", "--pixels", "50",
               "--validation", data(), "--quiet", "--terms", "caf\xE9"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const std::string kReplaced = "caf\xEF\xBF\xBD";
  EXPECT_NE(RunOssa({"info", model()}).out.find(kReplaced), std::string::npos);
}

TEST_F(BadDataSet, ATruncatedImageIsNamed) {
  const fs::path image = fs::path(data()) / "parts" / "000001.png";
  fs::resize_file(image, fs::file_size(image) / 2);
  ExpectRefused("000001.png");
}

TEST_F(BadDataSet, AnImageOfAnotherFormatIsNamed) {
  fs::copy_file(fs::path(data()) / "depth" / "000001.png",
                fs::path(data()) / "parts" / "000001.png", fs::copy_options::overwrite_existing);
  ExpectRefused("000001.png");
}

// Opening a pipe without a writer blocks for ever.
TEST_F(BadDataSet, NamedPipesAreRefusedWithoutWaiting) {
  for (const char* name : {"truth.jsonl", "manifest.json"}) {
    fs::remove(fs::path(data()) / name);
    ASSERT_EQ(mkfifo((fs::path(data()) / name).c_str(), 0600), 0);
    ExpectRefused(name);
  }
}

// As README.md says of data sets of other makers.
TEST_F(BadDataSet, UserImagesAreRequiredForSeveralPeopleOnly) {
  fs::remove_all(fs::path(data()) / "users");
  const std::vector<std::string> words = {
      "train", data(),     "--out", model(),        "--trees", "1",      "--depth",
      "3",     "--pixels", "50",    "--validation", data(),    "--quiet"};
  const CommandResult result = RunOssa(words);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  fs::remove(model());
  fs::remove_all(data());
  ASSERT_EQ(RunOssa({"render", "--mocap", "authored", "--out", data(), "--frames", "4", "--size",
                     "96x72", "--people", "2", "--quiet"})
                .exit_status,
            0);
  fs::remove(fs::path(data()) / "users" / "000003.png");
  ExpectRefused("users/000003.png");
}

TEST_F(BadDataSet, AMissingManifestIsNamed) {
  fs::remove(fs::path(data()) / "manifest.json");
  ExpectRefused("data");
}

std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class TrainingRuns : public BadDataSet {
 protected:
  std::vector<std::string> Arguments(const std::string& name) const {
    return {"train",     data(), "--validation", data(),    "--out",    (folder_ / name).string(),
            "--trees",   "2",    "--depth",      "8",       "--pixels", "200",
            "--threads", "1",    "--quiet",      "--resume"};
  }
  std::string Unbroken() const {
    const CommandResult result = RunOssa(Arguments("whole.ossa"));
    EXPECT_EQ(result.exit_status, 0) << result.err;
    return BytesOf(folder_ / "whole.ossa");
  }
};

TEST_F(TrainingRuns, WriteTheSameBytesForAnyNumberOfRanks) {
  if (!fs::exists("/usr/bin/mpirun")) GTEST_SKIP() << "no mpirun";
  const std::string whole = Unbroken();
  for (const char* ranks : {"2", "4"}) {
    const std::string name = std::string("ranks") + ranks + ".ossa";
    std::vector<std::string> argv = {
        "/usr/bin/mpirun", "--allow-run-as-root", "--oversubscribe", "-np", ranks,
        test::OssaPath()};
    for (const std::string& argument : Arguments(name)) argv.push_back(argument);
    const CommandResult result = test::RunProgram(argv);
    ASSERT_EQ(result.exit_status, 0) << result.err;
    EXPECT_EQ(BytesOf(folder_ / name), whole) << ranks << " ranks";
  }
}

TEST_F(TrainingRuns, WriteTheSameBytesWhenKilledAndResumed) {
  const std::string whole = Unbroken();
  for (const int after_ms : {60, 120, 200}) {
    test::RunningCommand run = test::StartOssa(Arguments("killed.ossa"));
    std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
    run.Signal(SIGKILL);
    run.Wait(test::kCommandTimeout);
  }
  EXPECT_EQ(RunOssa(Arguments("killed.ossa")).exit_status, 0);
  EXPECT_EQ(BytesOf(folder_ / "killed.ossa"), whole);
}

// A script of several trainings that was interrupted after this one repeated it.
TEST_F(TrainingRuns, SkipAFinishedModelOfTheSameData) {
  const std::string whole = Unbroken();
  const auto written = fs::last_write_time(folder_ / "whole.ossa");
  std::vector<std::string> words = Arguments("whole.ossa");
  std::erase(words, "--quiet");
  const CommandResult again = RunOssa(words);
  EXPECT_EQ(again.exit_status, 0);
  EXPECT_NE(again.err.find("whole.ossa: is there already"), std::string::npos) << again.err;
  EXPECT_EQ(fs::last_write_time(folder_ / "whole.ossa"), written);
  const std::string manifest = data() + "/manifest.json";
  std::string text = BytesOf(manifest);
  const size_t motion = text.find(R"("motion": ")");
  ASSERT_NE(motion, std::string::npos);
  text[motion + 11] = text[motion + 11] == '0' ? '1' : '0';
  std::ofstream(manifest) << text;
  const CommandResult other = RunOssa(words);
  EXPECT_EQ(other.err.find("is there already"), std::string::npos);
  EXPECT_NE(other.err.find("--validation " + data() + ": the trees are grown on it, too"),
            std::string::npos)
      << other.err;
}

// A shell's completion ends folders with a slash: the data set's name was not on the card.
TEST_F(TrainingRuns, WriteTheSameBytesForEquivalentOptions) {
  const std::string whole = Unbroken();
  const std::string out = folder_ / "otherwise.ossa";
  const CommandResult result =
      RunOssa({"train", data() + "/", "--validation=" + data() + "/", "--trees=2", "--depth", "8",
               "--pixels=200", "--threads=2", "--memory=1G", "--out=" + out, "--quiet"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_TRUE(BytesOf(out) == whole);
  const std::string info = RunOssa({"info", out}).out;
  EXPECT_NE(info.find("ossa train data --validation data --trees 2"), std::string::npos) << info;
  EXPECT_NE(info.find("no second stage, no joint-conditioned relabelling"), std::string::npos);
}

// The size of the proposals was not counted.
TEST_F(TrainingRuns, KeepTheModelWithinTheSizeLimit) {
  const size_t limit = Unbroken().size() - 100;
  std::vector<std::string> words = Arguments("small.ossa");
  words.insert(words.end(), {"--max-megabytes", std::to_string(1e-6 * static_cast<double>(limit))});
  const CommandResult result = RunOssa(words);
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_LE(fs::file_size(folder_ / "small.ossa"), limit);
}

TEST_F(TrainingRuns, ReportPresentAndMissingCheckpoints) {
  std::vector<std::string> words = Arguments("new.ossa");
  std::erase(words, "--quiet");
  EXPECT_NE(RunOssa(words).err.find("new.ossa.checkpoint: not there"), std::string::npos);
  std::ofstream(folder_ / "new.ossa.checkpoint") << "of another run";
  std::erase(words, "--resume");
  EXPECT_NE(RunOssa(words).err.find("new.ossa.checkpoint: left by an interrupted run"),
            std::string::npos);
}

// Each killed run leaves another, as large as a model.
TEST_F(TrainingRuns, DeleteIncompleteCheckpointsOfKilledRuns) {
  for (const char* name : {"new.ossa.checkpoint", "new.ossa"}) {
    std::ofstream(folder_ / (std::string(name) + ".partial-00c0ffee0000")) << "half";
  }
  EXPECT_EQ(RunOssa(Arguments("new.ossa")).exit_status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "new.ossa"));
  EXPECT_FALSE(fs::exists(folder_ / "new.ossa.checkpoint.partial-00c0ffee0000"));
  EXPECT_FALSE(fs::exists(folder_ / "new.ossa.partial-00c0ffee0000"));
}

// Ctrl-C was ignored until the end.
TEST_F(TrainingRuns, ResumeFromTheTreesWhenInterruptedWhileJointsAreLearned) {
  std::vector<std::string> words(500, data());  // seconds to read
  words.insert(words.begin(), "train");
  words.insert(words.end(), {"--out", (folder_ / "cut.ossa").string(), "--trees", "1", "--depth",
                             "1", "--pixels", "9", "--threads", "1", "--validation", data()});
  test::RunningCommand run = test::StartOssa(words);
  ASSERT_TRUE(run.WaitForError(" a second", test::kCommandTimeout));
  run.Signal(SIGINT);
  const CommandResult cut = run.Wait(test::kCommandTimeout);
  EXPECT_EQ(cut.exit_status, 1);
  EXPECT_NE(cut.err.find("--resume goes on from"), std::string::npos) << cut.err;
  EXPECT_FALSE(fs::exists(folder_ / "cut.ossa"));
}

// --refinement needs classes that are our labels: other classes aborted the program.
TEST_F(BadDataSet, AForestOfOtherClassesOrTargetsIsRefused) {
  std::ofstream(folder_ / "pcl.txt") << "1\n100 0 0 100 50\n3\n9\n";
  const auto import = [&](const char* out, std::vector<std::string> more) {
    more.insert(more.begin(), {"train", "--import-pcl", folder_ / "pcl.txt", "--quiet", "--out",
                               (folder_ / out).string()});
    EXPECT_EQ(RunOssa(more).exit_status, 0);
  };
  import("trees.ossa", {});
  import("joints.ossa", {"--validation", data()});
  const auto again = [&](const char* trees, std::vector<std::string> more) {
    more.insert(more.begin(), {"train", data(), "--validation", data(), "--out", model(),
                               "--trees-of", (folder_ / trees).string()});
    return RunOssa(more);
  };
  const CommandResult no_joints = again("trees.ossa", {});
  EXPECT_EQ(no_joints.err.find("the trees are grown on it"), std::string::npos) << no_joints.err;
  EXPECT_EQ(no_joints.exit_status, 1);
  EXPECT_NE(no_joints.err.find("trees.ossa: targets"), std::string::npos) << no_joints.err;
  const CommandResult no_parts = again("joints.ossa", {"--refinement", data()});
  EXPECT_EQ(no_parts.exit_status, 1);
  EXPECT_NE(no_parts.err.find("joints.ossa: classes"), std::string::npos) << no_parts.err;
  EXPECT_EQ(again("joints.ossa", {}).exit_status, 0);
}

// Terms with a path, of a data set rendered with --mocap FOLDER/cmu, were not on the card.
TEST_F(BadDataSet, CardNamesTermsOfMotionByItsFolder) {
  std::string manifest = BytesOf(data() + "/manifest.json");
  const std::string ours = "motion authored: ossa's own, MIT";
  ASSERT_NE(manifest.find(ours), std::string::npos);
  manifest.replace(manifest.find(ours), ours.size(), "motion /home/me/cmu/: see https://a.org/b");
  std::ofstream(data() + "/manifest.json") << manifest;
  const CommandResult result =
      RunOssa({"train", data(), "--out", model(), "--trees", "1", "--depth", "3", "--pixels", "50",
               "--validation", data(), "--quiet"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(RunOssa({"info", model()}).out.find("\"motion cmu: see https://a.org/b\""),
            std::string::npos);
}

// The card left out the data of a kept relabelling.
TEST_F(BadDataSet, CardKeepsTheDataOfAKeptRelabelling) {
  const std::string fresh = RenderEnoughForASecondStage(), again = folder_ / "again.ossa";
  const std::vector<std::string> quick = {"--validation", fresh, "--quiet", "--out"};
  const auto train = [&](std::vector<std::string> words, const std::string& out) {
    words.insert(words.end(), quick.begin(), quick.end());
    words.push_back(out);
    const CommandResult result = RunOssa(words);
    EXPECT_EQ(result.exit_status, 0) << result.err;
    return RunOssa({"info", out}).out;
  };
  const std::string refined = train(
      {"train", fresh, "--trees", "1", "--depth", "3", "--pixels", "50", "--refinement", fresh},
      model());
  EXPECT_NE(refined.find("512 units, joint-conditioned"), std::string::npos) << refined;
  const std::string kept = train({"train", fresh, "--trees-of", model()}, again);
  EXPECT_NE(kept.find("no second stage, joint-conditioned"), std::string::npos) << kept;
  EXPECT_NE(kept.find("\"refinement_data\""), std::string::npos) << kept;
}

// Its examples are the same ones, and trees, pose prior and proposals are kept.
TEST_F(BadDataSet, SecondStageAloneIsThatOfTheWholeTraining) {
  const std::string fresh = RenderEnoughForASecondStage(), again = folder_ / "again.ossa";
  const std::vector<std::string> second = {"--refinement",
                                           fresh,
                                           "--validation",
                                           fresh,
                                           "--refinement-units",
                                           "32",
                                           "--refinement-epochs",
                                           "2",
                                           "--refinement-dropout",
                                           "0.3",
                                           "--quiet"};
  const auto train = [&](std::vector<std::string> words) {
    words.insert(words.end(), second.begin(), second.end());
    const CommandResult result = RunOssa(words);
    EXPECT_EQ(result.exit_status, 0) << result.err;
  };
  train({"train", fresh, "--out", model(), "--trees", "1", "--depth", "3", "--pixels", "50"});
  train({"train", "--trees-of", model(), "--out", again});
  forest::ForestData whole = forest::ReadForestModel(model()).data();
  forest::ForestData alone = forest::ReadForestModel(again).data();
  EXPECT_NE(alone.manifest, whole.manifest) << "its card names the command";
  alone.manifest = whole.manifest;
  const auto bytes = [&](forest::ForestData kept) {
    forest::WriteForestModel(folder_ / "kept.ossa", forest::ForestModel(std::move(kept)));
    return BytesOf(folder_ / "kept.ossa");
  };
  EXPECT_EQ(bytes(std::move(alone)), bytes(std::move(whole)));
}

TEST_F(BadDataSet, SecondStageAloneNeedsDataAndAPosePrior) {
  const auto train = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"train", "--out", folder_ / "x.ossa", "--trees-of"});
    return RunOssa(more);
  };
  std::ofstream(folder_ / "pcl.txt") << "1\n100 0 0 100 50\n3\n9\n";
  const std::string joints = folder_ / "joints.ossa";
  ASSERT_EQ(RunOssa({"train", "--import-pcl", folder_ / "pcl.txt", "--quiet", "--validation",
                     data(), "--out", joints})
                .exit_status,
            0);
  const CommandResult no_validation = train({joints, "--refinement", data()});
  EXPECT_EQ(no_validation.exit_status, 2);
  EXPECT_NE(no_validation.err.find("--validation"), std::string::npos) << no_validation.err;
  const CommandResult no_prior = train({joints, "--refinement", data(), "--validation", data()});
  EXPECT_EQ(no_prior.exit_status, 1);
  EXPECT_NE(no_prior.err.find("joints.ossa: "), std::string::npos) << no_prior.err;
}

// The messages were "no image shows an object" and none.
TEST_F(BadDataSet, TooFewImagesToHoldOutAreReported) {
  const CommandResult all_held = RunOssa({"train", data(), "--out", model(), "--quiet"});
  EXPECT_EQ(all_held.exit_status, 1);
  EXPECT_NE(all_held.err.find("--validation; found 4"), std::string::npos) << all_held.err;
}

TEST_F(TrainingRuns, RelearnTheSameProposalsForTheSameTrees) {
  const std::string whole = Unbroken();
  const auto again = [&](const std::string& trees_of, const std::string& out) {
    const CommandResult result =
        RunOssa({"train", data(), "--validation", data(), "--trees-of",
                 (folder_ / trees_of).string(), "--out", (folder_ / out).string()});
    EXPECT_EQ(result.exit_status, 0) << result.err;
    return BytesOf(folder_ / out);
  };
  const std::string once = again("whole.ossa", "once.ossa");
  EXPECT_FALSE(once.empty());
  EXPECT_NE(RunOssa({"info", (folder_ / "once.ossa").string()}).out.find("proposals_command"),
            std::string::npos);
  EXPECT_EQ(again("whole.ossa", "twice.ossa"), once);
}

TEST(EvaluateCommand, ReportsADamagedModelInOneLine) {
  const test::TemporaryFolder folder;
  const fs::path model = folder.path() / "broken.ossa";
  std::ofstream(model) << "ossafrst and then nothing of use";
  const CommandResult result = RunOssa({"evaluate", model.string(), folder.path().string()});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("broken.ossa"), std::string::npos) << result.err;
}

// The error came only after the evaluation.
TEST_F(TrainingRuns, EvaluateReportsAnUnwritableReportAtStart) {
  Unbroken();
  // No path is left to write beside it under: the system takes 4095 bytes.
  fs::path deep = folder_.path();
  while (deep.string().size() < 3900) deep /= std::string(100, 'd');
  fs::create_directories(deep);
  const fs::path model = deep / std::string(4085 - deep.string().size(), 'm').append(".ossa");
  fs::rename(folder_ / "whole.ossa", model);
  const CommandResult result = RunOssa({"evaluate", model.string(), data(), "--card", "mine"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(test::LineCount(result.err), 1) << result.err;  // no progress before it
  EXPECT_EQ(result.out, "");
}

// --json - is stdout, as of compare and track; it wrote a file named "-".
TEST_F(TrainingRuns, EvaluateWithADashWritesNoFileOfThatName) {
  Unbroken();
  const CommandResult result =
      test::RunProgram({"/bin/sh", "-c", R"(cd "$2" && "$1" evaluate whole.ossa "$3" --json -)",
                        "sh", test::OssaPath(), folder_.path().string(), data()});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("{")) << result.out;
  EXPECT_FALSE(fs::exists(folder_ / "-"));
}

// Before the hours of tree training.
TEST_F(BadDataSet, TooFewImagesForARefinementAreReportedBeforeTraining) {
  for (const std::string& fresh : {data(), std::string("/nowhere")}) {
    const CommandResult result =
        RunOssa({"train", data(), "--out", model(), "--trees", "1", "--depth", "3", "--validation",
                 data(), "--refinement", fresh});
    EXPECT_EQ(result.exit_status, 1);
    EXPECT_EQ(test::LineCount(result.err), 1) << result.err;  // no progress of trees before it
    EXPECT_NE(result.err.find(fresh), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(model() + ".checkpoint"));
  }
}

TEST_F(BadDataSet, OutputOverAnInputIsRefused) {
  const auto manifest = data() + "/manifest.json";
  EXPECT_EQ(RunOssa({"train", data(), "--out", manifest}).exit_status, 2);
  EXPECT_EQ(RunOssa({"train", "--import-pcl", manifest, "--out", manifest}).exit_status, 2);
  EXPECT_TRUE(fs::file_size(manifest) > 0);
}

TEST(TrainCommand, WrongUsageExitsWithTwo) {
  EXPECT_EQ(RunOssa({"train", "d", "--out", "x.ossa", "--trees", "0"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"train", "--out", "x.ossa"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"train", "d", "--out", "x.ossa", "--depth", "99"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"train", "d", "--out", "x.ossa", "--memory", "many"}).exit_status, 2);
}

// They were ignored: the model was not the requested one.
TEST(TrainCommand, RefusesTreeOptionsWhenNoTreesAreTrained) {
  const std::vector<std::pair<std::string, std::string>> of_trees = {
      {"--trees", "2"},   {"--depth", "3"},           {"--candidates", "9"},
      {"--memory", "1G"}, {"--min-node-pixels", "5"}, {"--vote-depth", "3"}};
  for (const auto& [option, value] : of_trees) {
    for (const std::string kept : {"--trees-of", "--import-pcl"}) {
      const CommandResult result =
          RunOssa({"train", "--out", "x.ossa", kept, "m.ossa", option, value});
      EXPECT_EQ(result.exit_status, 2) << option;
      EXPECT_NE(result.err.find(option + ": expected not with " + kept), std::string::npos)
          << result.err;
    }
  }
  EXPECT_EQ(RunOssa({"train", "d", "--import-pcl", "t", "--out", "x.ossa"}).exit_status, 2);
  EXPECT_EQ(
      RunOssa({"train", "--import-pcl", "t", "--out", "x.ossa", "--refinement", "d"}).exit_status,
      2);
}

// The message named the field of the C++ struct.
TEST(TrainCommand, ReportsNumbersOutOfRangeByTheirOption) {
  const std::vector<std::pair<std::string, std::string>> beyond = {
      {"--node-pixels", "99"},    {"--min-node-pixels", "1"}, {"--refill-pixels", "-1"},
      {"--box", "2000"},          {"--offsets", "1"},         {"--min-gain", "-0.1"},
      {"--context-share", "1.1"}, {"--vote-depth", "19"},     {"--memory", "1K"}};
  for (const auto& [option, value] : beyond) {
    const CommandResult result = RunOssa({"train", "d", "--out", "x.ossa", option, value});
    EXPECT_EQ(result.exit_status, 2) << option;
    EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(option), std::string::npos) << result.err;
  }
}

TEST_F(TrainingRuns, NameTheFirstOptionThatDiffersFromACheckpoint) {
  std::vector<std::string> words = Arguments("cut.ossa");
  words.insert(words.end(), {"--candidates", "20000"});  // so many that it does not end meanwhile
  test::RunningCommand run = test::StartOssa(words);
  const auto end = std::chrono::steady_clock::now() + test::kCommandTimeout;
  while (!fs::exists(folder_ / "cut.ossa.checkpoint") && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  run.Signal(SIGKILL);
  run.Wait(test::kCommandTimeout);
  words.back() = "300";
  const CommandResult other = RunOssa(words);
  EXPECT_EQ(other.exit_status, 1);
  EXPECT_EQ(test::LineCount(other.err), 2) << other.err;  // and that it is validated on its data
  EXPECT_NE(other.err.find("cut.ossa.checkpoint: checkpoint of another run: candidates: expected "
                           "300 as in this run, found 20000"),
            std::string::npos)
      << other.err;
}

}  // namespace
}  // namespace ossa::tests
