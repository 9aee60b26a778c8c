#pragma once
#include <functional>
#include <string>
#include <vector>

#include "recon/gp/learned_models.h"
#include "recon/methods/reconstructor.h"
#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {

/// What is learned from and what is then tested; never the same people.
struct Fold {
  std::string name;  // of what is tested
  std::vector<const RecordedPair*> train;
  std::vector<const RecordedPair*> test;
};

/// One fold a subject: all others to learn from, those for which `tested` is true to test.
std::vector<Fold> LeaveOneSubjectOut(const std::vector<RecordedPair>& pairs,
                                     const std::function<bool(const RecordedPair&)>& tested);

/// Frames [begin, end) of a recording.
RecordedPair Part(const RecordedPair& pair, size_t begin, size_t end, const std::string& subject);

/// The postures that both have, to learn from; evenly thinned.
std::vector<recon::PosturePair> PairsOf(const std::vector<const RecordedPair*>& recordings);

/// One method over the tested clips of all folds.
struct MethodScore {
  std::string method;
  std::vector<ClipMetrics> clips;
  double ms_per_frame = 0.0;
};

/// Runs `method` ("raw" and "butterworth" included) with `options` over the folds, learning from
/// each fold's training clips where the method learns. Kept in the experiment's cache.
MethodScore RunFolds(ExperimentContext& context, const std::string& data,
                     const std::vector<Fold>& folds, const std::string& method,
                     const recon::ReconstructorOptions& options);

/// One method over one recording, nothing learned but what the options bring.
recon::SkeletonSequence RunMethod(const recon::SkeletonSequence& observed,
                                  const std::string& method,
                                  const recon::ReconstructorOptions& options);

/// Calls body(i) for 0 <= i < count on so many threads; the first exception comes back.
void InParallel(size_t count, int threads, const std::function<void(size_t)>& body);

/// Mean or median over the clips that have the number.
std::optional<double> Average(const std::vector<ClipMetrics>& clips,
                              std::optional<double> ClipMetrics::*member);
std::optional<double> Median(const std::vector<ClipMetrics>& clips,
                             std::optional<double> ClipMetrics::*member);
std::string Number(const std::optional<double>& value, int digits = 2);

/// Methods that need pairs to learn from.
bool Learns(const std::string& method);

/// KERAAL, Microsoft's CSV files, KinectGait: jumps, hand snaps, wrong bones before and after.
Table GrossFailureTable(const ExperimentContext& context, const std::vector<std::string>& methods,
                        const recon::ReconstructorOptions& options);

}  // namespace ossa::tools
