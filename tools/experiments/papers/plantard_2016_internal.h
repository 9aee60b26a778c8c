#pragma once
#include <string>
#include <vector>

#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {

/// Figure 5 of metrics [method][scenario], methods as in the paper and after them ours; `seen` are
/// those of the frames in which the sensor saw somebody. A scenario in which a method has nothing
/// to compare counts for none.
Table MakePlantard2016FigureFive(const std::vector<std::string>& labels,
                                 const std::vector<std::vector<ClipMetrics>>& clips,
                                 const std::vector<std::vector<ClipMetrics>>& seen);

/// Figure 8: the four frames, each of another performance, in which raw is worst, eq. 13 of
/// pairs[method][scenario], methods as labelled; where the sensor saw nobody no frame counts.
Table MakePlantard2016FigureEight(const std::vector<std::string>& labels,
                                  const std::vector<std::vector<PairedTracks>>& pairs);

/// Section 8.2: tests between the first three methods.
Table MakePlantard2016Tests(const std::vector<std::string>& labels,
                            const std::vector<std::vector<ClipMetrics>>& clips);

/// The parameter `database_mocap`: what the database was made of.
std::string ReadDatabaseMotion(Parameters& parameters);

/// Figure 9: `method` (plantard-2016) over the hard scenarios, one parameter of the graph changed
/// at a time.
Table MakePlantard2016FigureNine(ExperimentContext& context, const MethodRun& method,
                                 const std::vector<RecordedPair>& hard);

}  // namespace ossa::tools
