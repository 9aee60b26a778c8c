#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "recon/methods/reconstructor.h"
#include "recon/models/learned_models.h"
#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {

/// A posture database and where it came from.
struct OpenDatabase {
  std::filesystem::path path;
  std::shared_ptr<const recon::PostureDatabase> postures;
};
/// --database of the study, else the shipped one.
OpenDatabase LoadDatabase(const ExperimentContext& context);
/// The parameter `best_prior`.
bool ReadUsesPrior(Parameters& parameters);
/// What best completes postures by: the shipped prior, or nothing where the study names a database
/// or says best_prior = 0, so that it is the database's postures.
std::shared_ptr<const recon::PosturePrior> LoadPrior(ExperimentContext& context);

/// A method with its settings, as a study compares it.
struct MethodRun {
  std::string label;  // in tables
  recon::ReconstructorOptions options;
  std::string database_key;  // of a database that is not LoadDatabase(context): for the cache
  bool refines = false;      // over clips it starts from RecordedPair::refined, and best knows it
  bool physics = false;      // then the physical character follows, as --physics on
};

/// best as `ossa track` runs it: the shipped forest's joints are refined at the depth image, and it
/// knows their systematic errors.
/// `observer` is a study's: "forest" or "simulated".
void SetObserverCorrection(const std::string& observer, MethodRun* best);

/// The same, and the physical character follows: the last stage of all four papers.
MethodRun WithPhysics(MethodRun run);

/// The method over one recording; cached by content.
recon::SkeletonSequence RunMethod(const ExperimentContext& context, const MethodRun& run,
                                  const recon::SkeletonSequence& observed);

/// Metrics of one clip: people matched, the clocks taken to be the same.
ClipMetrics MeasureClip(const std::string& name, const recon::SkeletonSequence& truth,
                        const recon::SkeletonSequence& result);
PairedTracks PairClip(const std::string& name, const recon::SkeletonSequence& truth,
                      const recon::SkeletonSequence& result);

/// The method over every recording: one entry a clip.
std::vector<PairedTracks> RunOverClips(const ExperimentContext& context, const MethodRun& run,
                                       const std::vector<RecordedPair>& clips);
std::vector<ClipMetrics> MeasureAll(const std::vector<PairedTracks>& pairs);

/// Mean or median over the clips that have the number.
std::optional<double> Average(const std::vector<ClipMetrics>& clips,
                              std::optional<double> ClipMetrics::*member);
std::optional<double> Median(const std::vector<ClipMetrics>& clips,
                             std::optional<double> ClipMetrics::*member);
/// "mean (median)"; the mean alone of fewer than three clips.
std::string MeanAndMedian(const std::vector<ClipMetrics>& clips,
                          std::optional<double> ClipMetrics::*member);

/// Milliseconds a frame of the method, median over the frames of the recording. Not cached: a time
/// is of this machine and now.
double MedianStep_ms(const MethodRun& run, const recon::SkeletonSequence& observed);

/// Learns from the recordings, all but those of `left_out` (a subject; "" leaves nobody out), and
/// keeps the .ossagp in the study's cache. Throws InputError when nothing is left.
std::filesystem::path LearnWithout(const ExperimentContext& context,
                                   const std::vector<RecordedPair>& clips,
                                   const std::string& left_out,
                                   const recon::LearnOptions& options = {});

/// "1.23", "-" when there is none.
std::string Cell(const std::optional<double>& value, int digits = 2, double scale = 1.0);

}  // namespace ossa::tools
