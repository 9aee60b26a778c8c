#include "tools/nite2/hand_tracker_internal.h"
#include "tools/nite2/image_space.h"

namespace ossa::nite2 {

NiteStatus HandTracker::Read(Frame** frame) {
  const std::lock_guard lock(reading_);
  std::optional<CameraFrame> seen = NextFrame();
  if (!seen) return NITE_STATUS_ERROR;
  *frame = frames.Add(Make(std::move(*seen)));
  return NITE_STATUS_OK;
}

std::unique_ptr<HandTracker::Stored> HandTracker::Make(CameraFrame seen) {
  const tracker::BodyFrame bodies = people_.Track(seen.image);
  std::vector<SeenHand> hands = CollectHands(bodies);
  const std::vector<SeenHand> lone = lone_.Step(seen.image, bodies, hands, WaitedFor());
  hands.insert(hands.end(), lone.begin(), lone.end());
  auto stored = std::make_unique<Stored>();
  {
    const std::lock_guard lock(request_mutex_);
    mirrored_ = seen.mirrored;
    stored->hands = followed_.Step(hands, bodies.time_s, seen.image.camera, smoothing_, mirrored_);
    stored->gestures = watch_.Step(hands, gestures_, mirrored_);
  }
  Frame& frame = stored->frame;
  frame.handCount = static_cast<int>(stored->hands.size());
  frame.pHands = stored->hands.data();
  frame.gestureCount = static_cast<int>(stored->gestures.size());
  frame.pGestures = stored->gestures.data();
  frame.pDepthFrame = seen.delivered.get();
  frame.timestamp = seen.delivered->timestamp;
  frame.frameIndex = seen.delivered->frameIndex;
  stored->delivered = std::move(seen.delivered);
  return stored;
}

std::vector<Eigen::Vector3d> HandTracker::WaitedFor() const {
  const std::lock_guard lock(request_mutex_);
  return followed_.WaitedFor();
}

NiteHandId HandTracker::StartHand(const NitePoint3f& place) {
  const std::lock_guard lock(request_mutex_);
  return followed_.Start(FromNite(place, mirrored_));
}

void HandTracker::StopHand(NiteHandId id) {
  const std::lock_guard lock(request_mutex_);
  followed_.Stop(id);
}

void HandTracker::StopHands() {
  const std::lock_guard lock(request_mutex_);
  followed_.StopAll();
}

bool HandTracker::StartGesture(NiteGestureType type) {
  if (type < NITE_GESTURE_WAVE || type > NITE_GESTURE_HAND_RAISE) return false;
  const std::lock_guard lock(request_mutex_);
  gestures_.insert(type);
  return true;
}

void HandTracker::StopGesture(NiteGestureType type) {
  const std::lock_guard lock(request_mutex_);
  gestures_.erase(type);
}

void HandTracker::StopGestures() {
  const std::lock_guard lock(request_mutex_);
  gestures_.clear();
}

bool HandTracker::SetSmoothing(float factor) {
  if (!(factor >= 0.0F && factor <= 1.0F)) return false;
  const std::lock_guard lock(request_mutex_);
  smoothing_ = factor;
  return true;
}

float HandTracker::smoothing() const {
  const std::lock_guard lock(request_mutex_);
  return smoothing_;
}

}  // namespace ossa::nite2
