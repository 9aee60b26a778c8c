#pragma once
#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "recon/methods/reconstructor.h"
#include "recon/models/learned_models.h"
#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {

/// Clips for learning and for testing, of different people.
struct Fold {
  std::string name;  // of what is tested
  std::vector<const RecordedPair*> train;
  std::vector<const RecordedPair*> test;
  std::string key;  // for the cache: of the content of both
};

/// One fold per subject: learn from all other subjects, test the subject's clips for which `tested`
/// is true.
std::vector<Fold> LeaveOneSubjectOut(const std::vector<RecordedPair>& pairs,
                                     const std::function<bool(const RecordedPair&)>& tested);

/// Frames [begin, end) of a recording.
RecordedPair Part(const RecordedPair& pair, size_t begin, size_t end, const std::string& subject);

/// Training pairs of postures that both sides have, evenly thinned.
std::vector<recon::PosturePair> CollectPairs(const std::vector<const RecordedPair*>& recordings);

/// Results of one method over the tested clips of all folds.
struct MethodScore {
  std::string method;
  std::vector<ClipMetrics> clips;
  double ms_per_frame = 0.0;  // of processor time
};

/// The options with what `method` learned from the fold's training clips, if it learns.
recon::ReconstructorOptions LearnFold(const Fold& fold, const std::string& method,
                                      const recon::ReconstructorOptions& options);

struct FoldScore {
  std::vector<ClipMetrics> clips;
  double milliseconds = 0.0;  // of processor time that reconstruction took, summed over threads
};
/// Runs the method over the fold's tested clips without learning, with what the options contain.
FoldScore TestFold(const Fold& fold, const std::string& method,
                   const recon::ReconstructorOptions& options, int threads);

/// Clip metrics of these studies as JSON, for the cache.
nlohmann::json ClipsToJson(const std::vector<ClipMetrics>& clips);
std::vector<ClipMetrics> ClipsFromJson(const nlohmann::json& json);
std::string DescribeConstants(const recon::BestConstants& constants);
/// Cache key of all options that these studies vary, and of their files.
std::string ComputeOptionsKey(const ExperimentContext& context,
                              const recon::ReconstructorOptions& options);

/// Runs `method` (also "raw" and "butterworth") with `options` over the folds; learning methods
/// learn from each fold's training clips. Cached.
MethodScore RunFolds(ExperimentContext& context, const std::string& data,
                     const std::vector<Fold>& folds, const std::string& method,
                     const recon::ReconstructorOptions& options);

/// Runs a method over one recording without learning, with what the options contain.
recon::SkeletonSequence RunMethod(const recon::SkeletonSequence& observed,
                                  const std::string& method,
                                  const recon::ReconstructorOptions& options);

/// `best` with the whole recording at hand: constant bone lengths, non-causal smoothing.
inline constexpr const char* kBestOffline = "best-offline";
/// Suffix of methods that are followed by the physical character, the papers' last stage.
inline constexpr std::string_view kPlusPhysics = "+physics";
/// `best` with a lag of one and of two frames.
inline constexpr std::array kBestLater = {"best-lag-1", "best-lag-2"};
/// `best` without anything learned about the sensor (`--learned none`).
inline constexpr const char* kBestUnlearned = "best-learned-none";
/// The observation delayed by one and by two frames, as a reference: a gain that a mere delay also
/// has is none.
inline constexpr std::array kRawLater = {"raw-1-late", "raw-2-late"};

/// True for methods that learn from pairs; false for "raw" and "butterworth".
bool IsLearned(const std::string& method);
/// True if they also work without what they learn.
bool HasOptionalCorrection(const std::string& method);

/// A row of the table of methods.
std::vector<std::string> MethodRow(const std::string& data, const MethodScore& score);

/// A fold that learns without both subjects and tests both.
Fold WithoutBoth(const Fold& a, const Fold& b);

/// sdk_nested.cpp: `best` with constants chosen without the tested person. Adds a row to the table
/// of methods; returns the chosen constants of each person.
Table RunNested(ExperimentContext& context, const std::string& data, const std::vector<Fold>& folds,
                const recon::ReconstructorOptions& options, Table* methods);

/// The parameter `lag_every_nth_clip` of RunLag().
size_t ReadLagClips(ExperimentContext& context);

/// sdk_lag.cpp: `best` with frames of lag, and a low pass, with widths and cut-off chosen without
/// the tested person. A full study also lists all widths.
Table RunLag(ExperimentContext& context, const std::string& data, const std::vector<Fold>& folds,
             const recon::ReconstructorOptions& options);

/// sdk_incremental.cpp: incremental learning of liu-2016 on unknown people and movements.
Table RunIncremental(ExperimentContext& context, const std::vector<Fold>& folds,
                     const recon::ReconstructorOptions& options);

/// sdk_hardest.cpp: eq. 18 for each person and exercise of UI-PRMD in which the last method has an
/// error of 10 cm or more, and for all others together.
Table HardestTable(const std::string& data, const std::vector<MethodScore>& scores);

/// sdk_hardest.cpp: errors over all clips of UI-PRMD, and without unreliable truth: the person with
/// the worst alignment and clips in which sensor and markers disagree.
Table ReliableClipsTable(const std::string& data, const std::vector<MethodScore>& scores);

/// linear_bound.cpp: error of the best linear filter.
Table EmptyLinearBound();
void AddLinearBound(const std::string& data, const std::vector<Fold>& folds, Table* table);

/// KERAAL, Microsoft's CSV files, KinectGait: jumps, hand snaps, wrong bones before and after.
Table GrossFailureTable(const ExperimentContext& context, const std::vector<std::string>& methods,
                        const recon::ReconstructorOptions& options);

}  // namespace ossa::tools
