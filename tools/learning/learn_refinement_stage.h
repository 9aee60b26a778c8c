#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "forest/forest.h"
#include "recon/refine/refinement_cascade.h"

namespace ossa::tools {

// Constants: chosen on validation subjects, see docs/benchmarks/refinement.md; seed by convention.

struct RefinementStageOptions {
  recon::RefinementCascade after;        // whose stages come first
  std::string model_name = "the model";  // in errors
  int hidden = 256;  // units of each network's first layer, half as many of the second; 2..1024
  int epochs = 12;   // times that every person is read, as is and from each shifted place
  int shifted = 1;   // additional random starts near each joint
  double shift_m = 0.025;  // of such a place, standard deviation along each axis
  double rate = 1e-3;      // of learning, at its highest; no unit
  uint64_t seed = 1;
  int threads = 0;                                 // 0: all; they do not change the network
  std::function<void(int64_t, int64_t)> progress;  // steps done, steps in all
  std::function<bool()> stop;                      // true: end with TrainInterrupted
};

/// Learns one further stage: the offsets of the true joints from those of the earlier stages, on
/// the people of data sets, which the forest was not trained on, on their mirror images and from
/// shifted starts. If the earlier stages estimate bone lengths, these are inputs. The same bytes
/// for any number of threads. Throws InputError where too few people are seen.
recon::RefinementCascade LearnRefinementStage(const forest::ForestModel& model,
                                              const std::vector<std::filesystem::path>& datasets,
                                              const RefinementStageOptions& options);

}  // namespace ossa::tools
