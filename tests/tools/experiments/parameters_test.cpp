#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "depth/base/error.h"
#include "recon/body/body_model.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {
namespace {

/// Why asking is refused; "" if it is not.
template <typename Ask>
std::string ComplaintOf(const Ask& ask) {
  try {
    ask();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void ExpectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

class StudyParameters : public testing::Test {
 protected:
  Parameters From(const std::string& text) {
    std::ofstream(folder_ / "p.toml") << text;
    return Parameters::FromToml(folder_ / "p.toml");
  }
  std::string Complaint(const std::string& text) {
    try {
      Parameters parameters = From(text);
      parameters.Number("samples", 100);
      parameters.Texts("methods", {"none"});
      parameters.RequireAllUsed();
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  test::TemporaryFolder folder_;
};

TEST_F(StudyParameters, AreReadWithDefaultsAndSurviveARoundTrip) {
  Parameters p = From("samples = 7\nmethods = [\"none\", \"best\"]\nsizes = [1, 2.5]\n");
  EXPECT_EQ(p.Integer("samples", 100), 7);
  EXPECT_EQ(p.Texts("methods", {}).size(), 2u);
  EXPECT_EQ(p.Numbers("sizes", {})[1], 2.5);
  EXPECT_EQ(p.Text("kind", "usual"), "usual");
  EXPECT_NO_THROW(p.RequireAllUsed());
  Parameters again = From(p.Used());
  EXPECT_EQ(again.Text("kind", "other"), "usual");
  EXPECT_EQ(again.Integer("samples", 0), 7);
}

TEST_F(StudyParameters, MalformedAreRefusedByLine) {
  EXPECT_EQ(Complaint("samples = 3\n"), "");
  EXPECT_NE(Complaint("samples = \"many\"\n").find("line 1: expected samples as a number"),
            std::string::npos);
  EXPECT_NE(Complaint("\nsampels = 3\n").find("line 2"), std::string::npos);
  EXPECT_NE(Complaint("samples = \n").find("p.toml: line 1"), std::string::npos);
  EXPECT_NE(Complaint("[samples]\nx = 1\n").find("line 1: expected a name"), std::string::npos);
  EXPECT_NE(Complaint("samples = {a = 1}\n").find("no tables"), std::string::npos);
  EXPECT_NE(Complaint("methods = [\n  [\"none\"]]\n").find("line 2"), std::string::npos);
  EXPECT_NE(Complaint("samples = 35=\"\"\n").find("the end of the line"), std::string::npos);
  EXPECT_NE(Complaint("methods = [\"a\"").find("line 1"), std::string::npos);
  EXPECT_EQ(Complaint("methods =\t[  # [{\n  \"no[ne\"]\n"), "");
  EXPECT_NE(Complaint("samples = nan\n").find("finite"), std::string::npos);
  EXPECT_NE(Complaint("samples = true\n").find("samples as a number"), std::string::npos);
  EXPECT_EQ(Complaint("samples = \n").find('\n'), std::string::npos);
}

TEST_F(StudyParameters, TooSmallOrUnknownAreRefused) {
  Parameters p = From("folds = 0\nmethods = [\"best\", \"none\", \"bets\"]\nparts = []\n");
  EXPECT_EQ(p.Integer("folds", 1), 0);
  EXPECT_EQ(p.Integer("movers", 3, 2), 3);
  EXPECT_EQ(p.Integer("folds", 1, 0, 0), 0);
  EXPECT_NE(
      ComplaintOf([&] { p.Integer("folds", 1, 1); }).find("line 1: expected folds of 1 or more"),
      std::string::npos);
  EXPECT_NE(ComplaintOf([&] {
              p.Some("methods", {"none", "best"}, {});
            }).find("found 'bets'"),
            std::string::npos);
  EXPECT_TRUE(p.Some("parts", {"a"}).empty());
  const std::vector<std::string> in_order = {"best", "none", "bets"};
  EXPECT_EQ(p.Some("methods", {"none", "best", "bets"}, {}), in_order);
}

TEST_F(StudyParameters, KeepNonAsciiTextInQuotes) {
  EXPECT_EQ(From("kind = \"J\xC3\xBCrgen\"  # \xC3\xBC\n").Text("kind", ""), "J\xC3\xBCrgen");
  // Found by fuzzing: toml++ runs into what it declares unreachable.
  EXPECT_NE(Complaint("# r\n[\x0e").find("line 2"), std::string::npos);
  EXPECT_NE(Complaint("\nnoise_\xCB\x96 = 1\n").find("line 2: expected letters beyond ASCII"),
            std::string::npos);
  EXPECT_NE(
      Complaint("a = \"\"\"b \\\n\xEF\xBB\xBD\"\"\"\n").find("line 1: expected texts of one line"),
      std::string::npos);
  EXPECT_EQ(From("kind = \"\"\n").Text("kind", "x"), "");
  EXPECT_EQ(From("kind = \"a \\\"b\\\\\"\r\n").Text("kind", "x"), "a \"b\\");
  EXPECT_NE(Complaint("kind = \"a\\\n\"\n").find("line 1: expected texts"), std::string::npos);
  EXPECT_NE(Complaint("kind = \"a\\").find("line 1: expected texts"), std::string::npos);
}

TEST_F(StudyParameters, MayBeBooleans) {
  Parameters p = From("full = true\nsamples = 2\n");
  EXPECT_TRUE(p.Flag("full", false));
  EXPECT_FALSE(p.Flag("other", false));
  EXPECT_THROW(p.Flag("samples", false), InputError);
  EXPECT_NE(p.Used().find("full = true"), std::string::npos);
}

TEST_F(StudyParameters, OutOfRangeAreRefusedByLine) {
  Parameters p = From(
      "hours = -1\nsplit = \"tset\"\nmotion = \"/nowhere\"\nmotions = []\ndepths = [5, 30]\n"
      "images = [10, 10.5]\n");
  ExpectHas(ComplaintOf([&] { p.Number("hours", 1, 0); }), "line 1: expected hours of 0 or more");
  ExpectHas(ComplaintOf([&] { p.Number("hours", 1, 0, 720); }),
            "line 1: expected hours of 0 to 720");
  ExpectHas(ComplaintOf([&] {
              p.OneOf("split", {"train", "test"}, "test");
            }),
            "line 2: expected split as one of train, test; found 'tset'");
  ExpectHas(ComplaintOf([&] { p.Motion("motion", "authored"); }),
            "line 3: expected motion as a folder or file of motion");
  ExpectHas(ComplaintOf([&] { p.Motions("motions"); }), "line 4: expected motions as a list");
  ExpectHas(ComplaintOf([&] { p.Integers("depths", {5}, 1, 24); }),
            "line 5: expected depths each of 1 to 24");
  ExpectHas(ComplaintOf([&] { p.Integers("images", {5}, 1); }),
            "line 6: expected images as a list of whole numbers");
}

// Otherwise a misspelt parameter would be reported after hours.
TEST_F(StudyParameters, AreAllReadBeforeTheStudyBegins) {
  Parameters p = From("samples = 7\n");
  p.Integer("samples", 100);
  p.RequireAllUsed();
  EXPECT_EQ(p.Integer("samples", 100), 7) << "again";
  EXPECT_THROW(p.Integer("smaples", 100), std::logic_error);
}

class EveryExperiment : public StudyParameters {
 protected:
  // What RunExperiment() says of the parameters; it takes up nothing.
  std::string Refusal(const Experiment& experiment, const std::string& parameters) {
    ExperimentContext context;
    context.out = folder_ / "out";
    context.parameters = From(parameters);
    context.interrupted = [] { return true; };
    try {
      RunExperiment(std::string(experiment.name), context);
    } catch (const InputError& error) {
      EXPECT_FALSE(std::filesystem::exists(context.out)) << "begun";
      return error.what();
    } catch (const Interruption&) {
    }
    return {};
  }
};

TEST_F(EveryExperiment, RefusesAMisspeltParameterAtStart) {
  for (const Experiment& experiment : Experiments()) {
    SCOPED_TRACE(experiment.name);
    const std::string refusal = Refusal(experiment, "\nmisspelt = 3\n");
    ExpectHas(refusal, "p.toml: line 2");
    ExpectHas(refusal, "found misspelt");
  }
}

TEST_F(EveryExperiment, RefusesBadParametersOfLaterPartsAtStart) {
  const auto refusal = [&](const char* name, const std::string& parameters) {
    return Refusal(*FindExperiment(name), parameters);
  };
  const std::string line = "p.toml: line 1: expected ";
  ExpectHas(refusal("fit", "shape_people_per_height = 21\n"), line);
  ExpectHas(refusal("sdk", "lag_every_nth_clip = 0\n"), line);
  ExpectHas(refusal("plantard-2016", "database_mocap = \"/nowhere\"\n"), line);
  ExpectHas(refusal("person-classifier", "check_mocap = \"/nowhere\"\n"), line);
  ExpectHas(refusal("shum-ho-2012", "endurance_hours = -1\n"), line);
  ExpectHas(refusal("shum-ho-2012", "observer = \"forrest\"\n"), line);
  ExpectHas(refusal("shotton-2011", "depths = [5, 30]\n"), line);
  ExpectHas(refusal("liu-2016", "folds = 4\n"), line);
  ExpectHas(refusal("indoor-scenes", "method = \"bets\"\n"), line);
}

TEST_F(EveryExperiment, RefusesMissingFoldersAndFiles) {
  ExperimentContext context;
  context.out = folder_ / "out";
  context.interrupted = [] { return true; };
  context.shared = "/nowhere";
  EXPECT_THROW(RunExperiment("shum-2013", context), InputError);
  context.shared.clear();
  context.model = "/nowhere.ossa";
  EXPECT_THROW(RunExperiment("shum-2013", context), InputError);
}

TEST(CachedResults, AreComputedOnceAndReusedForTheSameKeyOnly) {
  const test::TemporaryFolder folder;
  ExperimentContext context;
  context.out = folder.path();
  int computed = 0;
  const auto compute = [&] { return "result " + std::to_string(++computed); };
  EXPECT_EQ(context.Cached("a", compute), "result 1");
  EXPECT_EQ(context.Cached("a", compute), "result 1");
  EXPECT_EQ(context.Cached("b", compute), "result 2");
  // A damaged cache file is computed again.
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache")) {
    std::ofstream(entry.path()) << "junk";
  }
  EXPECT_EQ(context.Cached("a", compute), "result 3");
}

// A result of an older program must not be taken for one of this: its key names the program and the
// libraries that made it by their content.
TEST(CachedResults, KeyContainsChecksumsOfTheProgramAndItsLibraries) {
  const std::string code = ComputeCodeKey();
  EXPECT_TRUE(code.starts_with(ComputeFileKey("/proc/self/exe") + " ")) << code;
  for (const char* library : {"depth", "forest", "recon", "synth", "tracker", "experiments"})
    EXPECT_NE(code.find(std::string("libossa_") + library + ".so"), std::string::npos) << code;
  EXPECT_EQ(code, ComputeCodeKey());
}

TEST(CachedResults, StopBeforeTheNextStepWhenInterrupted) {
  const test::TemporaryFolder folder;
  ExperimentContext context;
  context.out = folder.path();
  context.Cached("done", [] { return "kept"; });
  context.interrupted = [] { return true; };
  EXPECT_EQ(context.Cached("done", [] { return "again"; }), "kept");
  EXPECT_THROW(context.Cached("next", [] { return "never"; }), Interruption);
}

TEST(ExperimentCommand, RefusesUnknownStudiesAndMissingData) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "out";
  auto run = test::RunOssa({"experiment", "nonsense", "--out", out});
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_NE(run.err.find("expected one of body "), std::string::npos) << run.err;
  run = test::RunOssa({"experiment", "sdk", "--out", out});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("--shared"), std::string::npos) << run.err;
  run = test::RunOssa({"experiment", "sdk"});
  EXPECT_EQ(run.exit_status, 2);
}

TEST(StudyCommand, RefusesAFileWithMissingOrUnknownParameters) {
  const test::TemporaryFolder folder;
  const auto complaint = [&](const std::string& text) {
    std::ofstream(folder / "s.toml") << text;
    const auto run = test::RunOssa({"study", folder / "s.toml"});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
    return run.err;
  };
  EXPECT_NE(complaint("seed = 1\n").find("expected experiment"), std::string::npos);
  const std::string out = "out = \"" + (folder / "o").string() + "\"\n";
  EXPECT_NE(complaint("experiment = \"nonsense\"\n" + out).find("expected one of"),
            std::string::npos);
  EXPECT_NE(complaint("experiment = \"sdk\"\nthreads = 0\n" + out)
                .find("s.toml: line 2: expected threads"),
            std::string::npos);
}

// The message was about an image without pixels.
TEST(BodyStudy, ListsTheClipsWhenTheNamedOneIsMissing) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  std::ofstream(folder / "p.toml") << "only = [\"golf\", \"yodelling\"]\n";
  const auto run = test::RunOssa(
      {"experiment", "body", "--out", folder / "out", "--parameters", folder / "p.toml"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("no clip has 'yodelling' in its name; there are authored/"),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("authored/golf, "), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("golf/00"), std::string::npos) << run.err;
}

struct Refusal {
  const char *study, *parameters, *expected;
};

class AbsurdParameters : public testing::TestWithParam<Refusal> {};

TEST_P(AbsurdParameters, AreReportedInOneLine) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "p.toml") << GetParam().parameters;
  const auto result = test::RunOssa(
      {"experiment", GetParam().study, "--out", folder / "out", "--parameters", folder / "p.toml"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(GetParam().expected), std::string::npos) << result.err;
}

INSTANTIATE_TEST_SUITE_P(
    Studies, AbsurdParameters,
    testing::Values(Refusal{"indoor-scenes", "performances = 0\n",
                            "line 1: expected performances of 1 or more"},
                    Refusal{"rooms", "only = \"attic\"\n",
                            "indoor-scenes: no scenario has 'attic' in its name"},
                    Refusal{"body", "clips = 0\n", "line 1: expected clips of 1 to 40"},
                    Refusal{"body", "clips = 41\n", "line 1: expected clips of 1 to 40"},
                    Refusal{"body", "times = 21\n", "line 1: expected times of 1 to 20"},
                    Refusal{"sensor", "frames = 1\n", "line 1: expected frames of 2 to 10000"},
                    Refusal{"sensor", "frames = 10001\n", "line 1: expected frames of 2 to 10000"},
                    Refusal{"body", "mocap = []\n", "line 1: expected mocap as a list of one"},
                    Refusal{"sdk", "every_nth_clip = 0\n",
                            "line 1: expected every_nth_clip of 1 or more"},
                    Refusal{"sdk", "data = [\"hardst\"]\n", "found 'hardst'"},
                    Refusal{"sdk", "data = []\n", "expected some of correct, incorrect"},
                    Refusal{"sdk", "data = [\"hardest\"]\n", "expected some of correct, incorrect"},
                    Refusal{"sdk", "methods = [\"bets\"]\n", "found 'bets'"},
                    Refusal{"liu-2016", "folds = 0\n", "line 1: expected folds of 1 to 3"}),
    [](const auto& info) { return std::to_string(info.index); });

}  // namespace
}  // namespace ossa::tools
