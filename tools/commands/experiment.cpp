#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/warnings.h"
#include "tools/experiments/experiment.h"
#include "tools/experiments/page/page.h"

namespace ossa::commands {
namespace {

// Prints each warning once: studies load their models many times.
class NewWarnings {
 public:
  void PrintError(const std::string& warning) {
    const std::lock_guard lock(mutex_);
    if (said_.insert(warning).second) PrintWarnings("experiment", std::vector{warning});
  }

 private:
  std::mutex mutex_;
  std::set<std::string> said_;
};

std::string ListExperiments() {
  std::string list = "Experiments:";
  for (const tools::Experiment& e : tools::Experiments()) {
    list += fmt::format("\n  {:<16} {}", e.name, e.summary);
  }
  return list;
}

std::string Names() {
  std::string names;
  for (const tools::Experiment& e : tools::Experiments()) {
    names.append(names.empty() ? "" : " ").append(e.name);
  }
  return names;
}

// Runs a study with a progress bar, and prints its tables and parameters.
int RunAndPrint(const std::string& name, tools::ExperimentContext& context, bool quiet) {
  Progress progress(name, quiet);
  context.progress = [&](double done, double total, const std::string& note) {
    progress.Update(done, total, note);
  };
  context.interrupted = Interrupted;
  NewWarnings warnings;
  context.warn = [&](const std::string& warning) { warnings.PrintError(warning); };
  try {
    const auto tables = tools::RunExperiment(name, context);
    AtomicFile page(context.out / "index.html");
    page.stream() << tools::ExperimentPage(name, tables, context.out);
    page.Commit();
    fmt::print("ossa experiment {}, seed {}\n\n", name, context.seed);
    for (const tools::Table& table : tables) fmt::print("{}\n", tools::ToMarkdown(table));
    fmt::print("With plots: {}\n\n", (context.out / "index.html").string());
    fmt::print("Parameters (also in {}):\n{}", (context.out / "parameters.toml").string(),
               context.parameters.Used());
  } catch (const tools::Interruption&) {
    throw InputError(name + ": stopped; the same command goes on where it was");
  }
  return 0;
}

}  // namespace

int Experiment(int argc, char** argv) {
  CLI::App app("Run a study: a paper's tables and figures, printed beside the paper's own numbers");
  std::string name;
  std::string parameters;
  tools::ExperimentContext context;
  bool quiet = false;
  app.add_option("NAME", name, "the study, one of those below")->required();
  app.add_option(
         "--out", context.out,
         "folder for index.html (tables and plots), TABLE.md, summary.json, figures and the "
         "cache that lets it resume")
      ->required();
  app.add_option("--shared", context.shared, "folder of real recordings (real/, mocap/, papers/)");
  app.add_option("--parameters", parameters, "TOML file of the study's parameters");
  app.add_option("--model", context.model, "forest model instead of the shipped one");
  app.add_option("--database", context.database, "posture database instead of the shipped one");
  app.add_option("--seed", context.seed, "random seed")->capture_default_str();
  app.add_option("--threads", context.threads, "cores to use")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--full", context.full,
               "the long form: more clips, frames and settings (the short one takes minutes)");
  app.add_flag("--quiet", quiet, "no progress");
  app.footer(ListExperiments());
  Parse(app, argc, argv);

  if (tools::FindExperiment(name) == nullptr) {
    throw UsageError(fmt::format("NAME: expected one of {}, found '{}'", Names(), name));
  }
  if (!parameters.empty()) context.parameters = tools::Parameters::FromToml(parameters);
  return RunAndPrint(name, context, quiet);
}

int Study(int argc, char** argv) {
  CLI::App app("Run a study that a TOML file describes; the same command resumes it");
  std::string file;
  bool quiet = false;
  app.add_option("FILE", file,
                 "experiment = \"NAME\", out = \"FOLDER\"; shared, model, database, seed, threads, "
                 "full as the options of `ossa experiment`; every other key is a parameter of the "
                 "experiment")
      ->required();
  app.add_flag("--quiet", quiet, "no progress");
  app.footer(ListExperiments());
  Parse(app, argc, argv);

  tools::ExperimentContext context;
  context.parameters = tools::Parameters::FromToml(file);
  tools::Parameters& given = context.parameters;
  const std::string name = given.Text("experiment", "");
  context.out = given.Text("out", "");
  if (name.empty() || context.out.empty()) {
    throw InputError(file + ": expected experiment = \"NAME\" and out = \"FOLDER\"");
  }
  context.shared = given.Text("shared", "");
  context.model = given.Text("model", "");
  context.database = given.Text("database", "");
  context.full = given.Flag("full", false);
  context.threads = given.Integer("threads", 1, 1, 1024);
  context.seed = static_cast<uint64_t>(given.Integer("seed", 1));
  return RunAndPrint(name, context, quiet);
}

}  // namespace ossa::commands
