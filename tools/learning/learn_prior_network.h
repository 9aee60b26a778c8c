#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "recon/models/posture_prior.h"

namespace ossa::tools {

// Constants: chosen on validation subjects (`ossa experiment shum-2013 --seed 11`), seed by
// convention.

struct PriorNetworkOptions {
  int hidden = 512;  // rectified units, 1..1024
  int epochs = 12;   // passes over all examples
  int walks = 24;    // through each clip of weight 1, other joints hidden each time
  uint64_t seed = 1;
  int threads = 0;                                 // 0: all; they do not change the network
  std::function<void(int64_t, int64_t)> progress;  // steps done, steps in all
  std::function<bool()> stop;                      // true: end with TrainInterrupted
};

/// Learns the part of the pose prior that is not Gaussian (recon::PriorNetwork): the prior's filter
/// runs over the clips while limbs, halves of the body or random joints are hidden, and the network
/// learns the true bones from the filter's prediction. Every
/// second walk is of the mirror image. The same bytes for any number of threads. Throws InputError
/// where the clips hold too few postures.
recon::PriorNetwork LearnPriorNetwork(const recon::PosturePrior& prior,
                                      const std::vector<recon::PriorClip>& clips,
                                      const PriorNetworkOptions& options);

}  // namespace ossa::tools
