#pragma once
#include <optional>
#include <vector>

#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/compare/recordings.h"

namespace ossa::tools {

/// Eq. 18 of Shum 2013 apart for bones that the sensor saw at both ends and for those of which it
/// did not: a method should leave the first alone and repair the others.
struct VisibilityErrors {
  std::optional<double> visible_cm;
  std::optional<double> hidden_cm;
  double hidden_share = 0.0;  // of all bones compared
};

/// `results` as RunOverClips returns them for `clips`, whose truth says what was visible. Means
/// over the bones of all clips. Bones without both ends in truth and result are left out.
VisibilityErrors ErrorsByVisibility(const std::vector<RecordedPair>& clips,
                                    const std::vector<PairedTracks>& results);

}  // namespace ossa::tools
