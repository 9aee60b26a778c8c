#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/experiments/compare/joint_track.h"
#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {

/// One performance as a sensor saw it, 30 Hz or so, beside its truth.
struct FilterCase {
  PairedTracks tracks;
  std::optional<Eigen::Vector4d> floor;
};

/// Performances of one kind: a row of the filter table.
struct FilterData {
  std::string name;
  std::vector<FilterCase> cases;
};

/// Authored motion with noise; the dev recordings of real sensors under --shared, all that have
/// truth; rendered scenes as the forest sees them. `note` is added to what the table says.
std::vector<FilterData> MakeFilterData(ExperimentContext& context, const ActionClips& clips,
                                       std::string& note);

}  // namespace ossa::tools
