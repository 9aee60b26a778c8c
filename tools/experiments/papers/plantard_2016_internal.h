#pragma once
#include <string>
#include <vector>

#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {

/// Figure 5 from metrics [method][scenario], the paper's methods first; `seen`: metrics over frames
/// with observed joints. A scenario without comparable frames for one method counts for none.
Table MakePlantard2016FigureFive(const std::vector<std::string>& labels,
                                 const std::vector<std::vector<ClipMetrics>>& clips,
                                 const std::vector<std::vector<ClipMetrics>>& seen);

/// Figure 8: the four frames of different scenarios with the largest raw error (eq. 13), from
/// pairs[method][scenario]; frames without observed joints do not count.
Table MakePlantard2016FigureEight(const std::vector<std::string>& labels,
                                  const std::vector<std::vector<PairedTracks>>& pairs);

/// Section 8.2: tests between the first three methods.
Table MakePlantard2016Tests(const std::vector<std::string>& labels,
                            const std::vector<std::vector<ClipMetrics>>& clips);

/// The parameter `database_mocap`: the motion that the database was made from.
std::string ReadDatabaseMotion(Parameters& parameters);

/// Figure 9: `method` (plantard-2016) over the hard scenarios, one parameter of the graph changed
/// at a time.
Table MakePlantard2016FigureNine(ExperimentContext& context, const MethodRun& method,
                                 const std::vector<RecordedPair>& hard);

}  // namespace ossa::tools
