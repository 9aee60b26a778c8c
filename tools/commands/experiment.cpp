#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "depth/error.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/experiments/experiment.h"

namespace ossa::commands {
namespace {

std::string ListOfExperiments() {
  std::string list = "Experiments:";
  for (const tools::Experiment& e : tools::Experiments()) {
    list += fmt::format("\n  {:<16} {}", e.name, e.summary);
  }
  return list;
}

}  // namespace

int Experiment(int argc, char** argv) {
  CLI::App app("Run a study: a paper's tables and figures, printed beside the paper's own numbers");
  std::string name;
  std::string parameters;
  tools::ExperimentContext context;
  bool quiet = false;
  app.add_option("NAME", name, "which study")->required();
  app.add_option("--out", context.out,
                 "folder for TABLE.md, summary.json, figures and the cache that lets it resume")
      ->required();
  app.add_option("--shared", context.shared, "folder of real recordings (real/, mocap/, papers/)");
  app.add_option("--parameters", parameters, "TOML file of the study's parameters");
  app.add_option("--model", context.model, "forest model instead of the shipped one");
  app.add_option("--database", context.database, "posture database instead of the shipped one");
  app.add_option("--seed", context.seed, "of everything random")->capture_default_str();
  app.add_option("--threads", context.threads, "cores to use")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--full", context.full,
               "the long form: more clips, frames and settings (the short one takes minutes)");
  app.add_flag("--quiet", quiet, "no progress");
  app.footer(ListOfExperiments());
  Parse(app, argc, argv);

  if (!parameters.empty()) context.parameters = tools::Parameters::FromToml(parameters);
  Progress progress(name, quiet);
  context.progress = [&](double done, double total, const std::string& note) {
    progress.Update(done, total, note);
  };
  context.interrupted = Interrupted;
  try {
    const auto tables = tools::RunExperiment(name, context);
    fmt::print("ossa experiment {}, seed {}\n\n", name, context.seed);
    for (const tools::Table& table : tables) fmt::print("{}\n", tools::ToMarkdown(table));
  } catch (const tools::Interruption&) {
    throw InputError(name + ": stopped; the same command goes on where it was");
  }
  return 0;
}

}  // namespace ossa::commands
