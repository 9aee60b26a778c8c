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

/// A posture database and its path.
struct OpenDatabase {
  std::filesystem::path path;
  std::shared_ptr<const recon::PostureDatabase> postures;
};
/// Reads --database of the study, else the shipped database.
OpenDatabase LoadDatabase(const ExperimentContext& context);
/// The parameter `best_prior`.
bool ReadUsesPrior(Parameters& parameters);
/// The prior with which `best` completes postures: the shipped one, or null if the study has a
/// --database or best_prior = 0; then `best` uses the database.
std::shared_ptr<const recon::PosturePrior> LoadPrior(ExperimentContext& context);

/// A method with its settings in a study.
struct MethodRun {
  std::string label;  // in tables
  recon::ReconstructorOptions options;
  std::string database_key;  // of a database that is not LoadDatabase(context): for the cache
  bool refines = false;      // over clips it starts from RecordedPair::refined, and best knows it
  bool physics = false;      // then the physical character follows, as --physics on
};

/// Gives `best` the correction of the shipped forest's systematic errors and joints refined at the
/// depth image, as in `ossa track`, if `observer` is "forest".
void SetObserverCorrection(const std::string& observer, MethodRun* best);

/// The same method followed by the physical character, the last stage of all four papers.
MethodRun WithPhysics(MethodRun run);

/// Runs the method over one recording; cached by content.
recon::SkeletonSequence RunMethod(const ExperimentContext& context, const MethodRun& run,
                                  const recon::SkeletonSequence& observed);

/// Metrics of one clip; people are matched, clocks are taken as equal.
ClipMetrics MeasureClip(const std::string& name, const recon::SkeletonSequence& truth,
                        const recon::SkeletonSequence& result);
PairedTracks PairClip(const std::string& name, const recon::SkeletonSequence& truth,
                      const recon::SkeletonSequence& result);

/// Runs the method over all recordings; one entry per clip.
std::vector<PairedTracks> RunOverClips(const ExperimentContext& context, const MethodRun& run,
                                       const std::vector<RecordedPair>& clips);
std::vector<ClipMetrics> MeasureAll(const std::vector<PairedTracks>& pairs);

/// Mean or median over the clips that have the measure.
std::optional<double> Average(const std::vector<ClipMetrics>& clips,
                              std::optional<double> ClipMetrics::*member);
std::optional<double> Median(const std::vector<ClipMetrics>& clips,
                             std::optional<double> ClipMetrics::*member);
/// "mean (median)", or only the mean for fewer than three clips.
std::string MeanAndMedian(const std::vector<ClipMetrics>& clips,
                          std::optional<double> ClipMetrics::*member);

/// Processor time of the method per frame, milliseconds, median over the frames. Not cached.
double MedianStep_ms(const MethodRun& run, const recon::SkeletonSequence& observed);

/// Learns from all recordings but those of the subject `left_out` ("": from all). The .ossagp stays
/// in the study's cache. Throws InputError if no recordings are left.
std::filesystem::path LearnWithout(const ExperimentContext& context,
                                   const std::vector<RecordedPair>& clips,
                                   const std::string& left_out,
                                   const recon::LearnOptions& options = {});

/// "1.23", or "-" if empty.
std::string Cell(const std::optional<double>& value, int digits = 2, double scale = 1.0);

}  // namespace ossa::tools
