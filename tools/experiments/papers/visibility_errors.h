#pragma once
#include <optional>
#include <vector>

#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/compare/recordings.h"

namespace ossa::tools {

/// Eq. 18 of Shum 2013, separately for bones with both ends visible and for other bones: a method
/// should keep the former and correct the latter.
struct VisibilityErrors {
  std::optional<double> visible_cm;
  std::optional<double> hidden_cm;
  double hidden_share = 0.0;  // of all bones compared
};

/// `results`: from RunOverClips() for `clips`, whose truth has visibility. Means over the bones of
/// all clips; bones that lack an end in truth or result are left out.
VisibilityErrors ErrorsByVisibility(const std::vector<RecordedPair>& clips,
                                    const std::vector<PairedTracks>& results);

}  // namespace ossa::tools
