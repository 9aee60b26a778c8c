#include "tools/nite2/hands.h"

#include <algorithm>
#include <limits>

#include "tools/nite2/image_space.h"

namespace ossa::nite2 {
namespace {

using recon::Joint;

bool TouchesBorder(const Eigen::Vector3d& place_m, const depth::Camera& camera, double border) {
  const double u = camera.cx - camera.fx * place_m.x() / place_m.z();
  const double v = camera.cy - camera.fy * place_m.y() / place_m.z();
  const double margin = border * camera.width;
  return u < margin || v < margin || u > camera.width - margin || v > camera.height - margin;
}

}  // namespace

std::vector<SeenHand> CollectHands(const tracker::BodyFrame& frame) {
  std::vector<SeenHand> hands;
  for (const tracker::Body& body : frame.bodies) {
    if (body.state != tracker::BodyState::kTracked) continue;
    for (const bool left : {true, false}) {
      const auto at = [&](Joint joint) { return body.joints[joint]; };
      const auto hand = at(left ? Joint::kHandLeft : Joint::kHandRight);
      if (hand.state == recon::TrackingState::kNotTracked || hand.position_m.z() <= 0) continue;
      const auto elbow = at(left ? Joint::kElbowLeft : Joint::kElbowRight);
      const auto shoulder = at(left ? Joint::kShoulderLeft : Joint::kShoulderRight);
      hands.push_back(
          {body.id, left, {frame.time_s, hand.position_m, elbow.position_m, shoulder.position_m}});
    }
  }
  return hands;
}

NiteHandId FollowedHands::Start(const Eigen::Vector3d& place_m) {
  last_id_ = last_id_ == std::numeric_limits<NiteHandId>::max()
                 ? NiteHandId{1}
                 : static_cast<NiteHandId>(last_id_ + 1);
  hands_[last_id_] = {place_m, std::nullopt, false, 0.0};
  return last_id_;
}

std::vector<Eigen::Vector3d> FollowedHands::WaitedFor() const {
  std::vector<Eigen::Vector3d> places_m;
  for (const auto& [id, hand] : hands_) {
    if (!hand.body_id) places_m.push_back(hand.place_m);
  }
  return places_m;
}

// The same hand; else the nearest, as a body comes into view behind a lone hand or leaves. A body's
// hand is never confused with another body's or its other hand.
const SeenHand* FollowedHands::Find(const Hand& hand, const std::vector<SeenHand>& seen) const {
  const SeenHand* found = nullptr;
  double nearest_m = options_.near_m;
  for (const SeenHand& one : seen) {
    if (hand.body_id == one.body_id && hand.left == one.left) return &one;
    const double distance_m = (one.sample.hand_m - hand.place_m).norm();
    const bool of_bodies = hand.body_id && *hand.body_id > 0 && one.body_id > 0;
    if (of_bodies || distance_m > nearest_m) continue;
    nearest_m = distance_m;
    found = &one;
  }
  return found;
}

// The hand's state after this frame.
int FollowedHands::Follow(Hand& hand, const std::vector<SeenHand>& seen, double time_s,
                          const depth::Camera& camera, double smoothing) const {
  const SeenHand* found = Find(hand, seen);
  const bool is_new = !hand.body_id;
  if (found == nullptr) {
    const bool lost = is_new || time_s - hand.seen_s > options_.patience_s;
    return lost ? NITE_HAND_STATE_LOST : NITE_HAND_STATE_TRACKED;
  }
  const Eigen::Vector3d now_m = found->sample.hand_m;
  hand.place_m = is_new ? now_m : (smoothing * hand.place_m + (1 - smoothing) * now_m).eval();
  hand.body_id = found->body_id;
  hand.left = found->left;
  hand.seen_s = time_s;
  const int touching =
      TouchesBorder(now_m, camera, options_.border) ? NITE_HAND_STATE_TOUCHING_FOV : 0;
  return (is_new ? NITE_HAND_STATE_NEW : NITE_HAND_STATE_TRACKED) | touching;
}

std::vector<NiteHandData> FollowedHands::Step(const std::vector<SeenHand>& seen, double time_s,
                                              const depth::Camera& camera, float smoothing,
                                              bool mirrored) {
  std::vector<NiteHandData> all;
  for (auto at = hands_.begin(); at != hands_.end();) {
    const int state = Follow(at->second, seen, time_s, camera, smoothing);
    all.push_back({at->first, ToNite(at->second.place_m, mirrored), state});
    at = state == NITE_HAND_STATE_LOST ? hands_.erase(at) : std::next(at);
  }
  return all;
}

std::vector<NiteGestureData> GestureWatch::Step(const std::vector<SeenHand>& seen,
                                                const std::set<NiteGestureType>& wanted,
                                                bool mirrored) {
  std::vector<NiteGestureData> all;
  decltype(detectors_) still_there;  // motion before a hand was lost does not count
  for (const SeenHand& hand : seen) {
    if (!hand.moves_count) continue;
    for (const NiteGestureType type : wanted) {
      const auto key = std::make_tuple(hand.body_id, hand.left, type);
      auto known = detectors_.find(key);
      GestureDetector detector =
          known == detectors_.end() ? GestureDetector(type) : std::move(known->second);
      const auto state = detector.Step(hand.sample);
      if (state) all.push_back({type, ToNite(hand.sample.hand_m, mirrored), *state});
      still_there.emplace(key, std::move(detector));
    }
  }
  detectors_ = std::move(still_there);
  return all;
}

}  // namespace ossa::nite2
