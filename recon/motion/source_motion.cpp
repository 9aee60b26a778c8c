#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

SourceFrame FrameAt(const SourceMotion& motion, double time_s) {
  const double place = time_s / motion.frame_s;
  const auto last = static_cast<double>(motion.frame_count - 1);
  const double clamped = std::clamp(place, 0.0, last);
  const auto index = static_cast<size_t>(std::floor(clamped + 1e-3));
  const double fraction = clamped - static_cast<double>(index);
  // Files print 1/30 s as 0.0333333: times within a thousandth of a frame are equal.
  SourceFrame frame = motion.frame(index);
  if (fraction < 1e-3 || index + 1 >= motion.frame_count) return frame;
  const SourceFrame next = motion.frame(index + 1);
  for (size_t j = 0; j < frame.position.size(); ++j) {
    frame.position[j] += fraction * (next.position[j] - frame.position[j]);
    frame.rotation[j] = frame.rotation[j].slerp(fraction, next.rotation[j]);
  }
  return frame;
}

bool HasStep(const SourceMotion& motion, double step_s) {
  return std::abs(motion.frame_s - step_s) < 1e-3 * step_s;
}

size_t ResampledFrameCount(const SourceMotion& motion, double step_s) {
  constexpr double kMost_s = 36000.0;  // by hand: ten hours take a gigabyte at 30 Hz
  const double length_s = static_cast<double>(motion.frame_count - 1) * motion.frame_s;
  if (length_s > kMost_s) {
    throw InputError(fmt::format(
        "{}: expected a motion of at most 10 hours, found {:.4g} hours: {} frames of {:.4g} s",
        motion.source, length_s / 3600.0, motion.frame_count, motion.frame_s));
  }
  if (HasStep(motion, step_s)) return motion.frame_count;
  return static_cast<size_t>(std::floor(length_s / step_s + 1e-3)) + 1;
}

std::vector<Eigen::Vector3d> ZeroPose(const std::vector<SourceJoint>& joints) {
  std::vector<Eigen::Vector3d> positions;
  for (const SourceJoint& joint : joints) {
    const Eigen::Vector3d from =
        joint.parent < 0 ? Eigen::Vector3d::Zero() : positions[static_cast<size_t>(joint.parent)];
    positions.push_back(from + joint.offset);
  }
  return positions;
}

}  // namespace ossa::recon
