#pragma once
#include <memory>
#include <vector>

#include "tools/nite2/held_frames_internal.h"
#include "tools/nite2/live_tracker_internal.h"
#include "tools/nite2/users.h"

namespace ossa::nite2 {

/// A NiteUserTracker.
class UserTracker final : public LiveTracker {
 public:
  using Frame = NiteUserTrackerFrame;
  using Handle = NiteUserTrackerHandle;
  using LiveTracker::LiveTracker;

  NiteStatus Read(Frame** frame);
  NiteStatus StartSkeleton(NiteUserId id);
  void StopSkeleton(NiteUserId id);
  bool IsTracking(NiteUserId id) const;
  NiteStatus StartPose(NiteUserId id, NitePoseType type);
  void StopPose(NiteUserId id, NitePoseType type);
  void StopPoses(NiteUserId id);
  bool SetSmoothing(float factor);
  float smoothing() const;

  struct Stored {
    Frame frame{};
    OniFramePtr delivered;
    std::vector<NiteUserData> users;
    std::vector<NiteUserId> map;
  };
  HeldFrames<Stored> frames;

 private:
  std::unique_ptr<Stored> Make(CameraFrame seen);
  std::vector<NiteUserId> MakeUserMap(const depth::Image<uint8_t>& users, bool mirrored) const;
  bool IsKnown(NiteUserId id) const;

  mutable std::mutex request_mutex_;  // guards what follows
  UserWishes requests_;
  std::set<NiteUserId> known_;  // users who are not lost

  Users users_;  // under `reading_`
};

}  // namespace ossa::nite2
