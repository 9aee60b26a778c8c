#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "tools/commands/clock_options.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/skeleton_reading_options.h"
#include "tools/commands/warnings.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/experiment.h"

namespace ossa::commands {
namespace {

tools::Comparison Compared(const std::string& truth, const std::vector<std::string>& results,
                           tools::CompareOptions options, bool quiet) {
  Progress progress("comparing", quiet || !CanMoveCursor());  // for who watches alone
  options.progress = [&](size_t done, size_t of) {
    progress.Update(static_cast<double>(done), static_cast<double>(of));
  };
  try {
    return tools::Compare(truth, results, options);
  } catch (const tools::Interruption&) {
    throw InputError("compare: interrupted; nothing was written");
  }
}

std::string Formats() {
  std::string text =
      "TRUTH and RESULT are files, folders or archives (.tar.gz, .zip) of recordings; clips in "
      "them are matched by name. From a file that contains truth and estimate, each takes its own; "
      "FILE#truth and FILE#observed choose. Formats, found by content:";
  for (const std::string& format : recon::SkeletonFormats()) text += " " + format;
  return text;
}

struct CompareArguments {
  std::string truth;
  std::vector<std::string> results;
  std::string align = "none", joints = "all";
  ClockOptions clock;
  bool to_json = false;
  std::string json;  // "" or -: stdout
  std::string report;
  tools::CompareOptions options;
  bool quiet = false;

  bool json_to_stdout() const { return to_json && (json.empty() || json == "-"); }
};

void AddPairingOptions(CLI::App& app, CompareArguments& a) {
  app.add_option("--align", a.align, "rigid: one rotation and translation a clip (Procrustes)")
      ->check(CLI::IsMember({"none", "rigid"}))
      ->capture_default_str();
  app.add_option("--joints", a.joints,
                 "joints of a result that count: all with a position, or found: without those in "
                 "state not_tracked")
      ->check(CLI::IsMember({"all", "found"}))
      ->capture_default_str();
  a.clock.AddTo(app, "the results'");
}

void AddReadingOptions(CLI::App& app, tools::CompareOptions& options) {
  app.add_option("--columns", options.reading.columns,
                 "truth or observed, for files that hold both")
      ->check(CLI::IsMember({"truth", "vicon", "G", "ground-truth", "observed", "kinect",
                             "estimate", "a2j", "K", "P"}));
  app.add_option("--format", options.reading.format, "read every file in this format")
      ->check(CLI::IsMember(recon::SkeletonFormats()));
  app.add_option("--only", options.only, "only clips whose name contains TEXT (repeat for several)")
      ->allow_extra_args(false);
  app.add_option("--skip", options.skip, "no clips whose name contains TEXT (repeat for several)")
      ->allow_extra_args(false);
}

void DeclareOptions(CLI::App& app, CompareArguments& a) {
  app.add_option("TRUTH", a.truth, "the skeletons to compare with")->required();
  app.add_option("RESULT", a.results, "one or more results")->required();
  AddPairingOptions(app, a);
  app.add_option("--json", a.json, "write all numbers as JSON to FILE ('-' or none: stdout)")
      ->expected(0, 1);
  app.add_option("--report", a.report, "write one self-contained page with plots, FILE.html");
  AddReadingOptions(app, a.options);
  app.add_option("--seed", a.options.seed, "random seed of the bootstrap")->capture_default_str();
  app.add_flag("--quiet", a.quiet, "no tables on stdout");
  AddSkeletonReadingOptions(app, a.options.reading);
  app.footer(Formats() + "\n" + MappingHelp());
}

void CheckPairing(const CLI::App& app, CompareArguments& a) {
  a.to_json = app.count("--json") > 0;
  a.clock.Read(a.options.pairing);
}

void CheckOutputFiles(const CompareArguments& a) {
  std::vector<std::string> inputs = a.results;
  inputs.push_back(a.truth);
  inputs.push_back(a.options.reading.mapping_file);
  const std::string json = a.json_to_stdout() ? "" : a.json;
  CheckNotOtherKind("--json", a.json, ".json");
  CheckExtension("--report", a.report, ".html");
  CheckOutputs({json, a.report}, inputs);
  if (!json.empty()) AtomicFile::CheckWritable(json);
  if (!a.report.empty()) AtomicFile::CheckWritable(a.report);
}

void WriteReport(const tools::Comparison& comparison, const CompareArguments& a) {
  if (a.report.empty()) return;
  WriteText(a.report, tools::ToHtml(comparison));
  if (!a.quiet && !a.json_to_stdout()) fmt::print("\nReport: {}\n", a.report);
}

void PrintComparison(const tools::Comparison& comparison, const CompareArguments& a) {
  // Printed before the files are written, so that a full disk does not lose the numbers.
  if (a.json_to_stdout()) {
    fmt::print("{}", tools::ToJson(comparison));
  } else if (!a.quiet) {
    fmt::print("{}", tools::ToText(comparison));
  }
  DoEach("compare", {[&] {
                       if (!a.json_to_stdout()) WriteText(a.json, tools::ToJson(comparison));
                     },
                     [&] { WriteReport(comparison, a); }});
}

}  // namespace

int Compare(int argc, char** argv) {
  auto a = ParseConsistently<CompareArguments>(
      {"Compare skeletons with the truth, or with each other", DeclareOptions, CheckPairing}, argc,
      argv);
  a.options.pairing.rigid = a.align == "rigid";
  a.options.pairing.found_only = a.joints == "found";
  CheckOutputFiles(a);
  a.options.stop = Interrupted;
  a.options.reading.progress = ReadingBar(a.quiet);
  const tools::Comparison comparison = Compared(a.truth, a.results, a.options, a.quiet);
  PrintWarnings("compare", comparison.warnings);
  PrintComparison(comparison, a);
  return 0;
}

}  // namespace ossa::commands
