#include "tools/experiments/experiments_internal.h"

namespace ossa::tools {
namespace {

constexpr Experiment kExperiments[] = {
    {"body", "pictures of the 31 parts and of motions on the body", RunBody},
    {"sdk", "every method on every real recording; the SDK's skeletons as the baseline", RunSdk},
    {"shum-ho-2012", "the physical character: the paper's scenes, the filter, fig. 5",
     RunShumHo2012},
};

}  // namespace

std::span<const Experiment> Experiments() { return kExperiments; }

}  // namespace ossa::tools
