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

/// Motions for a study, if possible not used for any shipped database or model: mocap under
/// --shared (parameters `motion`, `only`), else ossa's authored clips with another seed than the
/// shipped database's. `count` clips, evenly chosen among those that last `frames` frames and stay
/// in view.
StudyMotion StudyMotions(ExperimentContext& context, size_t count, int frames);

/// Ten different clips of three people who are not in any shipped model's data, ordered so that
/// neighbours are different people. If --shared lacks them, or the study sets `motion` or `only`,
/// the clips of StudyMotions().
StudyMotion TenPerformances(ExperimentContext& context, int frames);

/// Authored clips of the given actions with `variations` movers each, from the study's own seed.
std::vector<recon::MotionClip> AuthoredMotions(const ExperimentContext& context,
                                               const std::vector<std::string>& actions,
                                               int variations);

}  // namespace ossa::tools
