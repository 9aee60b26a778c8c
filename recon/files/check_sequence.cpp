#include <fmt/format.h>

#include <sstream>

#include "depth/base/error.h"
#include "recon/files/check_sequence_internal.h"
#include "recon/files/text_lines_internal.h"

namespace ossa::recon {

void CheckPositions(const SkeletonSequence& sequence, const std::string& name) {
  constexpr double kFarthest_m = 1e6;  // by hand: no sensor sees as far
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      for (size_t j = 0; j < kJointCount; ++j) {
        if (!body.joints[j]) continue;
        const double far_m = body.joints[j]->position_m.cwiseAbs().maxCoeff();
        if (!(far_m > kFarthest_m)) continue;
        std::ostringstream found;
        found << far_m;
        throw InputError(name + ": frame " + std::to_string(frame.frame) + ": " +
                         std::string(kJointNames[j]) +
                         ": expected a position within 1000 km, found " + found.str() + " m");
      }
    }
  }
}

void CheckBodies(const SkeletonSequence& sequence, const std::string& name) {
  for (const SkeletonFrame& frame : sequence.frames) {
    const auto id = RepeatedBody(frame);
    if (!id) continue;
    throw InputError(fmt::format("{}: frame {}: expected each body once, found two of id {}", name,
                                 frame.frame, *id));
  }
}

void CheckTimes(const SkeletonSequence& sequence, const std::string& name) {
  const auto& frames = sequence.frames;
  size_t still = 0;
  for (size_t f = 1; f < frames.size(); ++f) {
    const double step_s = frames[f].time_s - frames[f - 1].time_s;
    still += step_s == 0.0 ? 1 : 0;
    const std::string wrong = WrongStep(step_s);
    if (wrong.empty()) continue;
    throw InputError(fmt::format("{}: frame {}: expected {}, found {} after {}", name,
                                 frames[f].frame, wrong, frames[f].time_s, frames[f - 1].time_s));
  }
  if (frames.size() < 3 || 2 * still <= frames.size()) return;
  throw InputError(
      fmt::format("{}: expected times that grow from frame to frame, found {} of {} "
                  "frames at the time of the one before",
                  name, still, frames.size()));
}

}  // namespace ossa::recon
