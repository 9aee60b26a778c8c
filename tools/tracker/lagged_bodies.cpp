#include "tools/tracker/lagged_bodies_internal.h"

#include <utility>
#include <vector>

namespace ossa::tracker {
namespace {

recon::TimedPosture ToTimedPosture(const Body& body, double time_s) {
  recon::TimedPosture one;
  one.time_s = time_s;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    one.posture.position_m[j] = body.joints[j].position_m;
    one.orientation[j] = body.joints[j].orientation;
    one.present[j] = body.joints[j].position_m.allFinite();
  }
  return one;
}

}  // namespace

std::optional<BodyFrame> LaggedBodies::Add(BodyFrame frame) {
  std::map<int, recon::TimedPosture>& people = window_.emplace_back();
  for (const Body& body : frame.bodies) {
    if (body.state == BodyState::kTracked) people[body.id] = ToTimedPosture(body, frame.time_s);
  }
  held_.push_back(std::move(frame));
  if (held_.size() <= static_cast<size_t>(options_.frames)) return std::nullopt;
  return TakeOldest();
}

std::optional<BodyFrame> LaggedBodies::DrainLag() {
  if (held_.empty()) return std::nullopt;
  BodyFrame frame = TakeOldest();
  if (held_.empty()) window_.clear();
  return frame;
}

BodyFrame LaggedBodies::TakeOldest() {
  const size_t at = window_.size() - held_.size();
  BodyFrame frame = std::move(held_.front());
  held_.pop_front();
  for (Body& body : frame.bodies) {
    if (options_.frames > 0 && body.state == BodyState::kTracked) Smooth(body, at);
  }
  while (window_.size() > held_.size() + static_cast<size_t>(options_.frames)) window_.pop_front();
  return frame;
}

// Frames without the person are skipped; SmoothedAt ends the trajectory at long gaps.
void LaggedBodies::Smooth(Body& body, size_t at) const {
  std::vector<recon::TimedPosture> trajectory;
  size_t own = 0;
  for (size_t f = 0; f < window_.size(); ++f) {
    const auto found = window_[f].find(body.id);
    if (found == window_[f].end()) continue;
    if (f == at) own = trajectory.size();
    trajectory.push_back(found->second);
  }
  const recon::TimedPosture smoothed = recon::SmoothedAt(trajectory, own, options_);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    body.joints[j].position_m = smoothed.posture.position_m[j];
    body.joints[j].orientation = smoothed.orientation[j];
  }
}

}  // namespace ossa::tracker
