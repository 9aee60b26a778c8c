#pragma once
#include <string>
#include <vector>

#include "recon/body/rig.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {

struct StudyMotion {
  std::vector<recon::MotionClip> clips;
  std::string note;  // description for tables
};

/// Reads the parameters of StudyMotions() and TenPerformances().
void ReadMotions(ExperimentContext& context);

/// Motions for a study that no shipped database or model was made from where possible: mocap under
/// --shared (parameters `motion`, `only`), else ossa's authored clips with movers of another seed
/// than the shipped database's. `count` clips that last `frames` frames and stay in view, evenly
/// spread over those there are.
StudyMotion StudyMotions(ExperimentContext& context, size_t count, int frames);

/// Ten performances, no two alike, of three people that nothing shipped was made from, in an order
/// in which neighbours are different people; where --shared lacks them or the study names a
/// `motion` or `only`, what StudyMotions has.
StudyMotion TenPerformances(ExperimentContext& context, int frames);

/// Authored clips of the given actions, `variations` movers each, with a seed of the study's own.
std::vector<recon::MotionClip> AuthoredMotions(const ExperimentContext& context,
                                               const std::vector<std::string>& actions,
                                               int variations);

}  // namespace ossa::tools
