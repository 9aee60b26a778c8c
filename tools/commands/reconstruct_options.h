#pragma once
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "recon/filters/lag_smoothing.h"
#include "recon/methods/reconstructor.h"
#include "tools/commands/floor_option.h"
#include "tools/commands/mechanics_options.h"
#include "tools/commands/method_options.h"
#include "tools/commands/outputs.h"
#include "tools/tracker/model_set.h"

namespace ossa::commands {

/// The parsed arguments of `ossa reconstruct`.
struct ReconstructArguments {
  std::string skeletons, out;
  tracker::ModelFiles files;  // the models that need no images
  recon::ReconstructorOptions options;
  recon::SkeletonReadOptions read;
  MechanicsOptions mechanics;
  FloorOption floor;
  std::string dynamics;  // file of inverse dynamics
  double mass_kg = 0.0;
  BonesOption bones;
  WriteOptions write;
  std::vector<double> weights;
  double cutoff_hz = 6.0;
  std::string lag;  // value of --lag; "": the default of the method
  bool quiet = false;
  bool no_reliability = false;
};

/// Throws UsageError for invalid arguments.
ReconstructArguments ParseReconstructOptions(int argc, char** argv);

/// The smoothing of the result, which keeps constant bone lengths.
recon::LagOptions LagFor(const ReconstructArguments& a);

}  // namespace ossa::commands
