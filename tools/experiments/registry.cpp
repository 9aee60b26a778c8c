#include "tools/experiments/experiments_internal.h"

namespace ossa::tools {
namespace {

constexpr Experiment kExperiments[] = {
    {"sdk", "every method on every real recording; the SDK's skeletons as the baseline", RunSdk},
};

}  // namespace

std::span<const Experiment> Experiments() { return kExperiments; }

}  // namespace ossa::tools
