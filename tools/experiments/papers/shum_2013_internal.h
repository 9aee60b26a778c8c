#pragma once
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/stage/staged.h"

namespace ossa::tools {

struct Shum2013Settings {
  std::string observer;
  int clips = 0, frames = 0;
};
Shum2013Settings ReadShum2013Settings(ExperimentContext& context);

/// The recordings and methods of `ossa experiment shum-2013`.
struct Shum2013Study {
  /// `occluded`: performances behind furniture and with held things are wanted, too.
  Shum2013Study(ExperimentContext& context, bool occluded);

  std::vector<RecordedPair> clean, furniture, held;  // classes (a), (b), (c) of table IV
  MethodRun raw, method_a, method_b, shum, kept, best;
  MethodRun best_of_truth;  // that expects no observer's errors: table III begins with true joints
  std::string note;
};

/// The database, and the test data.
Table TableOne(const ExperimentContext& context);
Table TableTwo(const Shum2013Study& study);

/// Every method before a tilted camera.
Table TiltTable(const ExperimentContext& context, const Shum2013Study& study);

/// What each term brings; figures 8 and 9.
std::vector<Table> MakeShum2013Sweeps(ExperimentContext& context, const Shum2013Study& study);

}  // namespace ossa::tools
