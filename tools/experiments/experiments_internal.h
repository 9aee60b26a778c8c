#pragma once
#include "tools/experiments/experiment.h"

namespace ossa::tools {

// One function an experiment, each in a file of its own.

/// The body's parts and motions on it, as pictures.
std::vector<Table> RunBody(ExperimentContext& context);
/// Every method on every real recording, the SDK's own skeletons as the baseline.
std::vector<Table> RunSdk(ExperimentContext& context);
/// Shum & Ho 2012: scenes with objects, the character as a filter, dimensions of a posture search.
std::vector<Table> RunShumHo2012(ExperimentContext& context);

}  // namespace ossa::tools
