#pragma once
#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {

struct Liu2016Settings {
  std::string observer;
  int movers = 0, frames = 0;
  int folds = 0;  // movers that are tested
};
Liu2016Settings ReadLiu2016Settings(ExperimentContext& context);

/// The recordings of `ossa experiment liu-2016`: clips are named "ACTION/MOVER"; a mover is a
/// subject, and each fold leaves one out.
struct Liu2016Study {
  Liu2016Study() = default;  // of recordings to be given
  explicit Liu2016Study(ExperimentContext& context);

  std::vector<RecordedPair> recordings;
  std::vector<std::string> folds;  // movers left out in turn
  std::string note;
  std::shared_ptr<const recon::PosturePrior> prior;  // of best

  /// Recordings of an action ("" = all) by the mover left out.
  std::vector<RecordedPair> TestClips(const std::string& action, const std::string& mover) const;
  /// A learned method for the fold, trained on the other movers.
  MethodRun Run(const ExperimentContext& context, const std::string& label,
                const std::string& method, const std::string& mover,
                const recon::LearnOptions& learn = {}) const;
};

/// Mean over folds and clips of an action; `prepare` may change the settings of each run.
std::optional<double> MeasureError(const ExperimentContext& context, const Liu2016Study& study,
                                   const std::string& action, const std::string& method,
                                   const std::function<void(MethodRun&)>& prepare = {},
                                   const recon::LearnOptions& learn = {});

/// Figures 3, 7 and 8.
std::vector<Table> MakeLiu2016Figures(ExperimentContext& context, const Liu2016Study& study);

}  // namespace ossa::tools
