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

/// What is learned from and what is then tested; never the same people.
struct Fold {
  std::string name;  // of what is tested
  std::vector<const RecordedPair*> train;
  std::vector<const RecordedPair*> test;
  std::string key;  // for the cache: of the content of both
};

/// One fold a subject: all others to learn from, those for which `tested` is true to test.
std::vector<Fold> LeaveOneSubjectOut(const std::vector<RecordedPair>& pairs,
                                     const std::function<bool(const RecordedPair&)>& tested);

/// Frames [begin, end) of a recording.
RecordedPair Part(const RecordedPair& pair, size_t begin, size_t end, const std::string& subject);

/// The postures that both have, to learn from; evenly thinned.
std::vector<recon::PosturePair> CollectPairs(const std::vector<const RecordedPair*>& recordings);

/// One method over the tested clips of all folds.
struct MethodScore {
  std::string method;
  std::vector<ClipMetrics> clips;
  double ms_per_frame = 0.0;  // of processor time
};

/// The options with what `method`, where it learns, made of the fold's training clips.
recon::ReconstructorOptions LearnFold(const Fold& fold, const std::string& method,
                                      const recon::ReconstructorOptions& options);

struct FoldScore {
  std::vector<ClipMetrics> clips;
  double milliseconds = 0.0;  // of processor time that reconstruction took, summed over threads
};
/// The method over the fold's tested clips; nothing is learned but what the options bring.
FoldScore TestFold(const Fold& fold, const std::string& method,
                   const recon::ReconstructorOptions& options, int threads);

/// For the cache: the numbers of a clip that the studies of recordings show.
nlohmann::json ClipsToJson(const std::vector<ClipMetrics>& clips);
std::vector<ClipMetrics> ClipsFromJson(const nlohmann::json& json);
std::string DescribeConstants(const recon::BestConstants& constants);
/// Everything of the options that a study of recordings varies, and the files they were read from.
std::string ComputeOptionsKey(const ExperimentContext& context,
                              const recon::ReconstructorOptions& options);

/// Runs `method` ("raw" and "butterworth" included) with `options` over the folds, learning from
/// each fold's training clips where the method learns. Kept in the experiment's cache.
MethodScore RunFolds(ExperimentContext& context, const std::string& data,
                     const std::vector<Fold>& folds, const std::string& method,
                     const recon::ReconstructorOptions& options);

/// One method over one recording, nothing learned but what the options bring.
recon::SkeletonSequence RunMethod(const recon::SkeletonSequence& observed,
                                  const std::string& method,
                                  const recon::ReconstructorOptions& options);

/// `best` by who has the whole recording: each frame has the same bones, and is smoothed by those
/// around it.
inline constexpr const char* kBestOffline = "best-offline";
/// What the name of a method ends with that the physical character follows, the papers' last stage.
inline constexpr std::string_view kPlusPhysics = "+physics";
/// `best` one and two frames later.
inline constexpr std::array kBestLater = {"best-lag-1", "best-lag-2"};
/// `best` with nothing learned of the sensor: what holds for any (`--learned none`).
inline constexpr const char* kBestUnlearned = "best-learned-none";
/// What was seen one and two frames before: a gain over raw that delay has, too, is none.
inline constexpr std::array kRawLater = {"raw-1-late", "raw-2-late"};

/// Methods that learn of pairs; false as well of "raw" and "butterworth".
bool IsLearned(const std::string& method);
/// ... a correction only, without which they work, too.
bool HasOptionalCorrection(const std::string& method);

/// A row of the table of methods.
std::vector<std::string> MethodRow(const std::string& data, const MethodScore& score);

/// Learned without either, tested on both.
Fold WithoutBoth(const Fold& a, const Fold& b);

/// sdk_nested.cpp: `best` with constants chosen without the person tested. Adds a row to the table
/// of methods; returns what was chosen for whom.
Table RunNested(ExperimentContext& context, const std::string& data, const std::vector<Fold>& folds,
                const recon::ReconstructorOptions& options, Table* methods);

/// The parameter `lag_every_nth_clip`: of RunLag().
size_t ReadLagClips(ExperimentContext& context);

/// sdk_lag.cpp: `best` with frames of lag, the low pass with its best cut-off, widths chosen
/// without the person tested. Of a long study all widths, too.
Table RunLag(ExperimentContext& context, const std::string& data, const std::vector<Fold>& folds,
             const recon::ReconstructorOptions& options);

/// sdk_incremental.cpp: what liu-2016 learns while it runs, of people and movements unknown to it.
Table RunIncremental(ExperimentContext& context, const std::vector<Fold>& folds,
                     const recon::ReconstructorOptions& options);

/// sdk_hardest.cpp: eq. 18 of each person and exercise of UI-PRMD in which the last of the methods
/// is 10 cm off and more, and of all others together.
Table HardestTable(const std::string& data, const std::vector<MethodScore>& scores);

/// sdk_hardest.cpp: all clips of UI-PRMD, and without the person whose truth is aligned worst and
/// the clips in which sensor and markers disagree.
Table ReliableClipsTable(const std::string& data, const std::vector<MethodScore>& scores);

/// linear_bound.cpp: what the best filter of fixed weights leaves.
Table EmptyLinearBound();
void AddLinearBound(const std::string& data, const std::vector<Fold>& folds, Table* table);

/// KERAAL, Microsoft's CSV files, KinectGait: jumps, hand snaps, wrong bones before and after.
Table GrossFailureTable(const ExperimentContext& context, const std::vector<std::string>& methods,
                        const recon::ReconstructorOptions& options);

}  // namespace ossa::tools
