#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/experiments/compare/joint_track.h"
#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {

/// One sequence as observed by a sensor at about 30 Hz, and its truth.
struct FilterCase {
  PairedTracks tracks;
  std::optional<Eigen::Vector4d> floor;
};

/// Sequences of one kind: a row of the filter table.
struct FilterData {
  std::string name;
  std::vector<FilterCase> cases;
};

/// Authored motion with noise; the development recordings of real sensors with truth under
/// --shared; rendered scenes observed by the forest. Appends to `note`.
std::vector<FilterData> MakeFilterData(ExperimentContext& context, const ActionClips& clips,
                                       std::string& note);

}  // namespace ossa::tools
