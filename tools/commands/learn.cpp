#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/skeleton_io.h"
#include "recon/methods/recorded_pairs.h"
#include "recon/models/learned_models.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/outputs.h"
#include "tools/commands/warnings.h"

namespace ossa::commands {
namespace {

/// Numbers people: recordings of one --observed whose names begin with the same folder (or archive)
/// are of one person.
class People {
 public:
  int Of(const std::string& observed_path, const std::string& clip) {
    const std::string name = observed_path + "\n" + clip.substr(0, clip.find('/'));
    return numbers_.try_emplace(name, static_cast<int>(numbers_.size())).first->second;
  }

 private:
  std::map<std::string, int> numbers_;
};

/// Clips of both sides by name; a single file on each side belongs together whatever its name.
void AddClips(const std::string& observed_path, const std::string& truth_path,
              const recon::SkeletonReadOptions& reading, People& people,
              std::vector<recon::PosturePair>& pairs) {
  const auto observed = recon::ReadSkeletonClips(observed_path, reading);
  const auto truth = recon::ReadSkeletonClips(truth_path, reading);
  if (Interrupted()) throw InputError("learn: interrupted; nothing was written");
  SayWarnings("learn", observed);
  SayWarnings("learn", truth);
  const size_t before = pairs.size();
  if (observed.size() == 1 && truth.size() == 1) {
    recon::AddPairs(observed[0].sequence, truth[0].sequence, pairs, people.Of(observed_path, ""));
  }
  std::map<std::string, const recon::SkeletonClip*> by_name;
  for (const auto& clip : truth) by_name[clip.name] = &clip;
  for (const auto& clip : observed) {
    const auto it = by_name.find(clip.name);
    if (it == by_name.end() || (observed.size() == 1 && truth.size() == 1)) continue;
    recon::AddPairs(clip.sequence, it->second->sequence, pairs,
                    people.Of(observed_path, clip.name));
  }
  if (pairs.size() == before) {
    throw InputError(observed_path + ": no frame matches one of " + truth_path +
                     "; expected recordings of the same names, the same frame numbers or times, "
                     "and at least 4 common joints less than 0.5 m apart (of other axes and "
                     "places nothing is learned)");
  }
}

}  // namespace

int Learn(int argc, char** argv) {
  CLI::App app("Learn a sensor's errors from pairs of observed and true skeletons");
  std::vector<std::string> observed, truth;
  std::string out;
  recon::LearnOptions options;
  recon::SkeletonReadOptions reading;
  reading.stop = Interrupted;
  bool quiet = false, correction_only = false;
  app.add_option("--observed", observed, "what the sensor said: files, folders or archives")
      ->required();
  app.add_option("--truth", truth, "what was true, in the same order; joints may be missing")
      ->required();
  app.add_option("--out", out, "the .ossagp file to write")->required();
  app.add_option("--seed", options.mixture.seed, "of the clustering")->capture_default_str();
  app.add_option("--regions", options.mixture.regions, "Q of liu-2016")
      ->capture_default_str()
      ->check(CLI::Range(1, recon::LearnOptions::kMostRegions));
  app.add_option("--samples", options.mixture.samples, "S of liu-2016")
      ->capture_default_str()
      ->check(CLI::Range(2, recon::LearnOptions::kMostSamples));
  app.add_option("--pairs", options.most_pairs, "at most, for liu-2016, full-gp and exemplar")
      ->capture_default_str();
  app.add_flag("--correction-only", correction_only,
               "only what best uses: quick to learn, a quarter of a megabyte");
  app.add_flag("--quiet", quiet, "no progress");
  AddMappingOption(app, reading.mapping_file);
  Parse(app, argc, argv);
  if (observed.size() != truth.size()) {
    throw UsageError(fmt::format("learn: {} --observed but {} --truth; expected as many",
                                 observed.size(), truth.size()));
  }
  if (options.most_pairs < 10) {
    throw UsageError(fmt::format("--pairs: expected 10 or more, found {}", options.most_pairs));
  }
  CheckNotOtherKind("--out", out, ".ossagp");
  options.correction.seed = options.mixture.seed;
  options.processes = !correction_only;

  std::vector<std::string> inputs = observed;
  inputs.insert(inputs.end(), truth.begin(), truth.end());
  inputs.push_back(reading.mapping_file);
  CheckOutputs({out}, inputs);
  AtomicFile::CheckWritable(out);
  std::vector<recon::PosturePair> pairs;
  People people;
  for (size_t i = 0; i < observed.size(); ++i) {
    AddClips(observed[i], truth[i], reading, people, pairs);
  }
  Progress progress("learn", quiet);
  const auto models = recon::LearnedModels::Learn(pairs, options, [&](int joint) {
    progress.Update(joint, recon::kJointCount, fmt::format("{} pairs", pairs.size()));
    return !Interrupted();
  });
  if (Interrupted()) throw InputError("learn: interrupted; nothing was written");
  models.Save(out);
  fmt::print("{}: learned from {} pairs\n", out, pairs.size());
  return 0;
}

}  // namespace ossa::commands
