#include "tools/experiments/papers/visibility_errors.h"

#include <algorithm>
#include <cmath>

namespace ossa::tools {
namespace {

/// The true body at that time; null if there is none.
const recon::BodyRecord* BodyAt(const recon::SkeletonSequence& truth, double time_s) {
  constexpr double kSameTime_s = 1e-3;  // rounding of printed times
  const auto frame =
      std::lower_bound(truth.frames.begin(), truth.frames.end(), time_s - kSameTime_s,
                       [](const recon::SkeletonFrame& f, double time) { return f.time_s < time; });
  const bool found = frame != truth.frames.end() && !frame->bodies.empty() &&
                     std::abs(frame->time_s - time_s) <= kSameTime_s;
  return found ? &frame->bodies.front() : nullptr;
}

bool Visible(const recon::BodyRecord& body, size_t joint) {
  return body.joints[joint] && body.joints[joint]->visible.value_or(true);
}

struct Sum {
  double total_cm = 0.0;
  int64_t bones = 0;
  std::optional<double> Mean() const {
    if (bones == 0) return std::nullopt;
    return total_cm / static_cast<double>(bones);
  }
};

}  // namespace

VisibilityErrors ErrorsByVisibility(const std::vector<RecordedPair>& clips,
                                    const std::vector<PairedTracks>& results) {
  Sum seen, hidden;
  for (size_t c = 0; c < std::min(clips.size(), results.size()); ++c) {
    const PairedTracks& pair = results[c];
    for (size_t f = 0; f < pair.truth.size(); ++f) {
      const recon::BodyRecord* body = BodyAt(clips[c].truth, pair.time_s[f]);
      for (size_t j = 1; body != nullptr && j < recon::kJointCount; ++j) {
        const auto parent = recon::ParentOf(j);
        const SparsePosture &truth = pair.truth[f], &made = pair.result[f];
        if (!truth.present[j] || !truth.present[parent]) continue;
        if (!made.present[j] || !made.present[parent]) continue;
        const Eigen::Vector3d off = (made.position_m[j] - made.position_m[parent]) -
                                    (truth.position_m[j] - truth.position_m[parent]);
        Sum& sum = Visible(*body, j) && Visible(*body, parent) ? seen : hidden;
        sum.total_cm += 100.0 * off.norm();
        ++sum.bones;
      }
    }
  }
  const int64_t all = seen.bones + hidden.bones;
  return {seen.Mean(), hidden.Mean(),
          all > 0 ? static_cast<double>(hidden.bones) / static_cast<double>(all) : 0.0};
}

}  // namespace ossa::tools
