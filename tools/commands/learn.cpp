#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "recon/files/skeleton_io.h"
#include "recon/models/learned_models.h"
#include "tools/commands/clock_options.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/skeleton_reading_options.h"
#include "tools/commands/warnings.h"
#include "tools/experiments/experiment.h"
#include "tools/learning/pair_recordings.h"

namespace ossa::commands {
namespace {

bool PrintReadingWarnings(const std::vector<recon::SkeletonClip>& clips) {
  PrintWarnings("learn", clips);
  return !Interrupted();
}

constexpr size_t kFewestPairs = recon::LearnOptions::kFewestPairs;

/// Throws InputError if the pairs are too few to learn anything.
void CheckPairs(const std::vector<std::string>& observed,
                const std::vector<recon::PosturePair>& pairs) {
  if (pairs.size() >= kFewestPairs) return;
  throw InputError(fmt::format(
      "{}: expected {} frames or more that match the truth's, in all recordings, found {}",
      observed.back(), kFewestPairs, pairs.size()));
}

recon::LearnedModels LearnUntilInterrupted(const std::vector<recon::PosturePair>& pairs,
                                           const recon::LearnOptions& options,
                                           const std::function<bool(int)>& progress) try {
  return recon::LearnedModels::Learn(pairs, options, progress);
} catch (const TrainInterrupted&) {
  throw InputError("learn: interrupted; nothing was written");
}

struct LearnArguments {
  std::vector<std::string> observed, truth;
  std::string out;
  recon::LearnOptions options;
  recon::SkeletonReadOptions reading;
  ClockOptions clock{.time = "none"};
  tools::PairOptions pairing;
  bool quiet = false, correction_only = false;
};

void Declare(CLI::App& app, LearnArguments& a) {
  recon::LearnOptions& options = a.options;
  app.add_option("--observed", a.observed, "the sensor's skeletons: files, folders or archives")
      ->required();
  app.add_option("--truth", a.truth, "the true skeletons, in the same order; joints may be missing")
      ->required();
  app.add_option("--out", a.out, "the .ossagp file to write")->required();
  app.add_option("--seed", options.mixture.seed, "random seed of the clustering")
      ->capture_default_str();
  app.add_option("--regions", options.mixture.regions, "regions of liu-2016 (Q in the paper)")
      ->capture_default_str()
      ->check(CLI::Range(1, recon::LearnOptions::kMostRegions));
  app.add_option("--samples", options.mixture.samples,
                 "samples per region of liu-2016 (S in the paper)")
      ->capture_default_str()
      ->check(CLI::Range(2, recon::LearnOptions::kMostSamples));
  app.add_option("--pairs", options.most_pairs,
                 "maximum number of pairs for liu-2016, full-gp and exemplar")
      ->capture_default_str();
  a.clock.AddTo(app, "the observed");
  app.add_flag("--correction-only", a.correction_only,
               "learn only what best uses: fast, a quarter of a megabyte");
  app.add_flag("--quiet", a.quiet, "no progress");
  AddSkeletonReadingOptions(app, a.reading);
  app.footer(MappingHelp());
}

void Check(const CLI::App&, LearnArguments& a) {
  if (a.observed.size() != a.truth.size()) {
    throw UsageError(fmt::format("learn: {} --observed but {} --truth; expected as many",
                                 a.observed.size(), a.truth.size()));
  }
  if (a.options.most_pairs < kFewestPairs) {
    throw UsageError(
        fmt::format("--pairs: expected {} or more, found {}", kFewestPairs, a.options.most_pairs));
  }
  CheckNotOtherKind("--out", a.out, ".ossagp");
  std::vector<std::string> inputs = a.observed;
  inputs.insert(inputs.end(), a.truth.begin(), a.truth.end());
  inputs.push_back(a.reading.mapping_file);
  CheckOutputs({a.out}, inputs);
  AtomicFile::CheckWritable(a.out);
  a.clock.Read(a.pairing);
}

LearnArguments ParseLearnOptions(int argc, char** argv) {
  LearnArguments a = ParseConsistently<LearnArguments>(
      {"Learn a sensor's errors from pairs of observed and true skeletons", Declare, Check}, argc,
      argv);
  a.pairing.stop = Interrupted;
  a.options.correction.seed = a.options.mixture.seed;
  a.options.correction.stop = a.options.window.stop = Interrupted;
  a.options.processes = !a.correction_only;
  a.reading.stop = Interrupted;
  a.reading.progress = ReadingBar(a.quiet);
  return a;
}

std::vector<recon::PosturePair> PairUntilInterrupted(const LearnArguments& a) try {
  tools::PairRecordingsOptions options;
  options.reading = a.reading;
  options.clock = a.pairing;
  options.read = PrintReadingWarnings;
  options.note = [quiet = a.quiet](const std::string& line) {
    if (!quiet) PrintError("learn: " + line + "\n");
  };
  return tools::PairRecordings(a.observed, a.truth, options);
} catch (const tools::Interruption&) {
  throw InputError("learn: interrupted; nothing was written");
}

}  // namespace

int Learn(int argc, char** argv) {
  const LearnArguments a = ParseLearnOptions(argc, argv);
  const auto pairs = PairUntilInterrupted(a);
  if (Interrupted()) throw InputError("learn: interrupted; nothing was written");
  CheckPairs(a.observed, pairs);
  Progress progress("learn", a.quiet);
  const auto models = LearnUntilInterrupted(pairs, a.options, [&](int joint) {
    progress.Update(joint, recon::kJointCount, fmt::format("{} pairs", pairs.size()));
    return !Interrupted();
  });
  if (Interrupted()) throw InputError("learn: interrupted; nothing was written");
  models.Save(a.out);
  fmt::print("{}: learned from {} pairs\n", a.out, pairs.size());
  return 0;
}

}  // namespace ossa::commands
