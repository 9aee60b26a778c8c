#pragma once
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/simulation/recording_simulator.h"

namespace ossa::tools {

struct Shum2013Settings {
  std::string observer;
  int clips = 0, frames = 0;
};
Shum2013Settings ReadShum2013Settings(ExperimentContext& context);

/// The recordings and methods of `ossa experiment shum-2013`.
struct Shum2013Study {
  /// `occluded`: also records the clips behind furniture and with held objects.
  Shum2013Study(ExperimentContext& context, bool occluded);

  std::vector<RecordedPair> clean, furniture, held;  // classes (a), (b), (c) of table IV
  MethodRun raw, method_a, method_b, shum, kept, best;
  MethodRun best_of_truth;  // `best` without the observer's correction: table III has true joints
  std::string note;

 private:
  void RecordClips(ExperimentContext& context, const Shum2013Settings& settings, bool occluded);
  void SetUpMethods(ExperimentContext& context, const std::string& observer);
};

/// Table I: the database. Table II: the test data.
Table TableOne(const ExperimentContext& context);
Table TableTwo(const Shum2013Study& study);

/// Table III, and lower bounds: the error of the best single posture of the database, and the limbs
/// with the largest errors of `best`.
Table TableThree(const ExperimentContext& context, const Shum2013Study& study);
Table ComputeTableThreeBounds(const ExperimentContext& context, const Shum2013Study& study);

/// Every method with a tilted camera.
Table TiltTable(const ExperimentContext& context, const Shum2013Study& study);

/// Gain of each term; figures 8 and 9.
std::vector<Table> MakeShum2013Sweeps(ExperimentContext& context, const Shum2013Study& study);

}  // namespace ossa::tools
