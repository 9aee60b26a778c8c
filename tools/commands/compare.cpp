#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/warnings.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/experiment.h"

namespace ossa::commands {
namespace {

void WriteText(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.Commit();
}

void ReadTimeAlignment(const std::string& word, tools::PairOptions& options) {
  if (word == "auto") {
    options.time = tools::TimeAlignment::kAuto;
  } else if (word == "none") {
    options.time = tools::TimeAlignment::kNone;
  } else if (word == "correlate") {
    options.time = tools::TimeAlignment::kCorrelate;
  } else if (CLI::detail::lexical_cast(word, options.offset_s) && std::isfinite(options.offset_s)) {
    options.time = tools::TimeAlignment::kFixed;
  } else {
    throw UsageError("--time: expected auto, none, correlate or seconds, found '" + word + "'");
  }
}

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
      "them are matched by name. Of a file that holds truth and estimate side by side each takes "
      "its own; FILE#truth and FILE#observed say which. Formats, found by content:";
  for (const std::string& format : recon::SkeletonFormats()) text += " " + format;
  return text;
}

}  // namespace

int Compare(int argc, char** argv) {
  CLI::App app("Judge skeletons against the truth, or against each other");
  std::string truth;
  std::vector<std::string> results;
  std::string align = "none";
  std::string joints = "all";
  std::string time = "auto";
  std::string json;
  std::string report;
  tools::CompareOptions options;
  bool quiet = false;
  app.add_option("TRUTH", truth, "the skeletons to compare with")->required();
  app.add_option("RESULT", results, "one or more results")->required();
  app.add_option("--align", align, "rigid: one rotation and translation a clip (Procrustes)")
      ->check(CLI::IsMember({"none", "rigid"}))
      ->capture_default_str();
  app.add_option("--joints", joints,
                 "of a result: all that have a place, or found, without those that say not_tracked "
                 "and were placed unseen")
      ->check(CLI::IsMember({"all", "found"}))
      ->capture_default_str();
  app.add_option("--time", time,
                 "auto: cross-correlation where the frame times disagree; none; correlate: always; "
                 "or seconds to add to the results' times")
      ->capture_default_str();
  app.add_option("--max-offset", options.pairing.max_offset_s, "how far correlation looks, seconds")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  auto* json_option =
      app.add_option("--json", json, "write all numbers as JSON to FILE ('-' or none: stdout)")
          ->expected(0, 1);
  app.add_option("--report", report, "write one self-contained page with plots, FILE.html");
  app.add_option("--columns", options.reading.columns, "truth or observed, for files of both")
      ->check(CLI::IsMember({"truth", "vicon", "G", "ground-truth", "observed", "kinect",
                             "estimate", "a2j", "K", "P"}));
  app.add_option("--format", options.reading.format, "read every file in this format")
      ->check(CLI::IsMember(recon::SkeletonFormats()));
  app.add_option("--only", options.only, "clips whose name holds TEXT (repeat for several)")
      ->allow_extra_args(false);
  app.add_option("--skip", options.skip, "no clips whose name holds TEXT (repeat for several)")
      ->allow_extra_args(false);
  app.add_option("--seed", options.seed, "of the bootstrap")->capture_default_str();
  app.add_flag("--quiet", quiet, "no tables on stdout");
  AddMappingOption(app, options.reading.mapping_file, false);
  app.footer(Formats() + "\n" + MappingHelp());
  Parse(app, argc, argv);
  ReadTimeAlignment(time, options.pairing);
  options.pairing.rigid = align == "rigid";
  options.pairing.found_only = joints == "found";

  const bool json_to_stdout = json_option->count() > 0 && (json.empty() || json == "-");
  std::vector<std::string> inputs = results;
  inputs.push_back(truth);
  inputs.push_back(options.reading.mapping_file);
  CheckNotOtherKind("--json", json, ".json");
  CheckExtension("--report", report, ".html");
  CheckOutputs({json_to_stdout ? "" : json, report}, inputs);
  if (!json.empty() && !json_to_stdout) AtomicFile::CheckWritable(json);
  if (!report.empty()) AtomicFile::CheckWritable(report);
  options.stop = Interrupted;
  options.reading.progress = ReadingBar(quiet);
  const tools::Comparison comparison = Compared(truth, results, options, quiet);
  SayWarnings("compare", comparison.warnings);
  if (json_to_stdout) {
    fmt::print("{}", tools::ToJson(comparison));
  } else {
    if (!json.empty()) WriteText(json, tools::ToJson(comparison));
    if (!quiet) fmt::print("{}", tools::ToText(comparison));
  }
  if (report.empty()) return 0;
  WriteText(report, tools::ToHtml(comparison));
  if (!quiet && !json_to_stdout) fmt::print("\nReport: {}\n", report);
  return 0;
}

}  // namespace ossa::commands
