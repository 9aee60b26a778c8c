#include <algorithm>

#include "tools/nite2/image_space.h"
#include "tools/nite2/user_tracker_internal.h"

namespace ossa::nite2 {

NiteStatus UserTracker::Read(Frame** frame) {
  const std::lock_guard lock(reading_);
  std::optional<CameraFrame> seen = NextFrame();
  if (!seen) return NITE_STATUS_ERROR;
  *frame = frames.Add(Make(std::move(*seen)));
  return NITE_STATUS_OK;
}

std::unique_ptr<UserTracker::Stored> UserTracker::Make(CameraFrame seen) {
  UserWishes requests;
  {
    const std::lock_guard lock(request_mutex_);
    requests = requests_;
  }
  people_.ChooseUsers(users_.BodiesWanted(requests));
  const tracker::BodyFrame bodies = people_.Track(seen.image);
  auto stored = std::make_unique<Stored>();
  stored->users = users_.Step(bodies, seen.image.depth_mm, requests, seen.mirrored);
  stored->map = MakeUserMap(bodies.users, seen.mirrored);
  Frame& frame = stored->frame;
  frame.userCount = static_cast<int>(stored->users.size());
  frame.pUser = stored->users.data();
  frame.userMap = {stored->map.data(), bodies.users.width, bodies.users.height,
                   static_cast<int>(sizeof(NiteUserId)) * bodies.users.width};
  frame.pDepthFrame = seen.delivered.get();
  frame.timestamp = seen.delivered->timestamp;
  frame.frameIndex = seen.delivered->frameIndex;
  if (bodies.floor) {
    frame.floorConfidence = 1.0F;
    frame.floor = FloorToNite(*bodies.floor, seen.mirrored);
  }
  stored->delivered = std::move(seen.delivered);
  const std::lock_guard lock(request_mutex_);
  known_.clear();
  for (const NiteUserData& user : stored->users) {
    if (user.state != NITE_USER_STATE_LOST) {
      known_.insert(user.id);
      continue;
    }
    requests_.skeletons.erase(user.id);  // the next user with this id was not requested
    requests_.poses.erase(user.id);
  }
  return stored;
}

std::vector<NiteUserId> UserTracker::MakeUserMap(const depth::Image<uint8_t>& users,
                                                 bool mirrored) const {
  std::vector<NiteUserId> map(users.data.size());
  std::array<NiteUserId, 256> user_of{};
  for (size_t body = 1; body < user_of.size(); ++body) {
    user_of[body] = users_.UserOf(static_cast<int>(body));
  }
  std::transform(users.data.begin(), users.data.end(), map.begin(),
                 [&](uint8_t body) { return user_of[body]; });
  for (int v = 0; mirrored && v < users.height; ++v) {
    const auto row = map.begin() + static_cast<ptrdiff_t>(v) * users.width;
    std::reverse(row, row + users.width);
  }
  return map;
}

bool UserTracker::IsKnown(NiteUserId id) const { return known_.count(id) > 0; }

NiteStatus UserTracker::StartSkeleton(NiteUserId id) {
  const std::lock_guard lock(request_mutex_);
  if (!IsKnown(id)) return NITE_STATUS_BAD_USER_ID;
  requests_.skeletons.insert(id);
  return NITE_STATUS_OK;
}

void UserTracker::StopSkeleton(NiteUserId id) {
  const std::lock_guard lock(request_mutex_);
  requests_.skeletons.erase(id);
}

bool UserTracker::IsTracking(NiteUserId id) const {
  const std::lock_guard lock(request_mutex_);
  return requests_.skeletons.count(id) > 0;
}

NiteStatus UserTracker::StartPose(NiteUserId id, NitePoseType type) {
  if (type != NITE_POSE_PSI && type != NITE_POSE_CROSSED_HANDS) return NITE_STATUS_ERROR;
  const std::lock_guard lock(request_mutex_);
  if (!IsKnown(id)) return NITE_STATUS_BAD_USER_ID;
  requests_.poses[id].insert(type);
  return NITE_STATUS_OK;
}

void UserTracker::StopPose(NiteUserId id, NitePoseType type) {
  const std::lock_guard lock(request_mutex_);
  const auto found = requests_.poses.find(id);
  if (found == requests_.poses.end()) return;
  found->second.erase(type);
  if (found->second.empty()) requests_.poses.erase(found);
}

void UserTracker::StopPoses(NiteUserId id) {
  const std::lock_guard lock(request_mutex_);
  requests_.poses.erase(id);
}

bool UserTracker::SetSmoothing(float factor) {
  if (!(factor >= 0.0F && factor <= 1.0F)) return false;
  const std::lock_guard lock(request_mutex_);
  requests_.smoothing = factor;
  return true;
}

float UserTracker::smoothing() const {
  const std::lock_guard lock(request_mutex_);
  return requests_.smoothing;
}

}  // namespace ossa::nite2
