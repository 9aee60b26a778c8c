#pragma once
#include <vector>

#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {

/// Figure 9: `method` (plantard-2016) over the hard scenarios, one parameter of the graph changed
/// at a time.
Table FigureNineOfPlantard2016(const ExperimentContext& context, const MethodRun& method,
                               const std::vector<RecordedPair>& hard);

}  // namespace ossa::tools
