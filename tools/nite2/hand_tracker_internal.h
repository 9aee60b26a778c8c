#pragma once
#include <memory>
#include <set>
#include <vector>

#include "tools/nite2/hands.h"
#include "tools/nite2/held_frames_internal.h"
#include "tools/nite2/live_tracker_internal.h"
#include "tools/nite2/lone_hands.h"

namespace ossa::nite2 {

/// A NiteHandTracker: hands of bodies, and hands without a body in view.
class HandTracker final : public LiveTracker {
 public:
  using Frame = NiteHandTrackerFrame;
  using Handle = NiteHandTrackerHandle;
  using LiveTracker::LiveTracker;

  NiteStatus Read(Frame** frame);
  NiteHandId StartHand(const NitePoint3f& place);
  void StopHand(NiteHandId id);
  void StopHands();
  bool StartGesture(NiteGestureType type);
  void StopGesture(NiteGestureType type);
  void StopGestures();
  bool SetSmoothing(float factor);
  float smoothing() const;

  struct Stored {
    Frame frame{};
    OniFramePtr delivered;
    std::vector<NiteHandData> hands;
    std::vector<NiteGestureData> gestures;
  };
  HeldFrames<Stored> frames;

 private:
  std::unique_ptr<Stored> Make(CameraFrame seen);
  std::vector<Eigen::Vector3d> WaitedFor() const;

  LoneHands lone_;                    // under `reading_`
  mutable std::mutex request_mutex_;  // guards what follows
  FollowedHands followed_;
  GestureWatch watch_;
  std::set<NiteGestureType> gestures_;
  float smoothing_ = 0.0F;
  bool mirrored_ = false;  // the newest frame
};

}  // namespace ossa::nite2
