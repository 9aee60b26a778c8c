#include "tools/nite2/users.h"

#include <algorithm>

#include "tools/nite2/image_space.h"

namespace ossa::nite2 {
namespace {

using recon::Joint;

constexpr double kForget_s = 10.0;  // as NiTE does, by convention

NiteBoundingBox EmptyBox() { return {{1e6F, 1e6F, 1e6F}, {-1.0F, -1.0F, -1.0F}}; }

void Extend(float u, float v, float z, NiteBoundingBox& box) {
  box.min = {std::min(box.min.x, u), std::min(box.min.y, v), std::min(box.min.z, z)};
  box.max = {std::max(box.max.x, u), std::max(box.max.y, v), std::max(box.max.z, z)};
}

// By body id: pixels of the delivered image, depth in millimetres.
std::map<int, NiteBoundingBox> FindBoxes(const depth::Image<uint8_t>& users,
                                         const std::vector<uint16_t>& depth_mm, bool mirrored) {
  std::map<int, NiteBoundingBox> boxes;
  for (int v = 0; v < users.height; ++v) {
    for (int u = 0; u < users.width; ++u) {
      const auto pixel =
          static_cast<size_t>(v) * static_cast<size_t>(users.width) + static_cast<size_t>(u);
      const uint8_t body = users.data[pixel];
      if (body == 0) continue;
      const auto box = boxes.try_emplace(body, EmptyBox()).first;
      Extend(static_cast<float>(mirrored ? users.width - 1 - u : u), static_cast<float>(v),
             depth_mm[pixel], box->second);
    }
  }
  return boxes;
}

// Head and trunk are tracked, on which all other joints depend.
bool IsSure(const tracker::Body& body) {
  for (const Joint joint : {Joint::kHead, Joint::kShoulderCenter, Joint::kShoulderLeft,
                            Joint::kShoulderRight, Joint::kHipCenter}) {
    if (body.joints[joint].state == recon::TrackingState::kNotTracked) return false;
  }
  return true;
}

// Not by its time: frames of some sensors have equal times.
bool IsInView(const tracker::BodyFrame& frame, int body_id) {
  return std::any_of(frame.bodies.begin(), frame.bodies.end(),
                     [body_id](const tracker::Body& body) { return body.id == body_id; });
}

void Blend(const NiteSkeletonJoint* before, float smoothing, NiteSkeletonJoint* joints) {
  for (int j = 0; j < NITE_JOINT_COUNT; ++j) {
    const auto blend = [&](float old, float now) {
      return smoothing * old + (1 - smoothing) * now;
    };
    const NitePoint3f &old = before[j].position, now = joints[j].position;
    joints[j].position = {blend(old.x, now.x), blend(old.y, now.y), blend(old.z, now.z)};
  }
}

void ForgetJoints(NiteSkeleton& skeleton) {
  skeleton = {};
  for (int j = 0; j < NITE_JOINT_COUNT; ++j) {
    skeleton.joints[j].jointType = static_cast<NiteJointType>(j);
    skeleton.joints[j].orientation.w = 1.0F;
  }
}

}  // namespace

NiteUserId Users::UserOf(int body_id) const {
  for (const auto& [id, user] : users_) {
    if (user.body_id == body_id) return id;
  }
  return 0;
}

std::vector<int> Users::BodiesWanted(const UserWishes& requests) const {
  std::vector<int> bodies;
  for (const auto& [id, user] : users_) {
    if (requests.skeletons.count(id) > 0 || requests.poses.count(id) > 0) {
      bodies.push_back(user.body_id);
    }
  }
  return bodies;
}

// A new user gets the lowest free id: programs index arrays of ten by it.
void Users::AssignIds(const tracker::BodyFrame& frame) {
  for (const tracker::Body& body : frame.bodies) {
    NiteUserId id = UserOf(body.id);
    if (id == 0) {
      for (id = 1; Has(id);) ++id;
      User& user = users_[id];
      user.body_id = body.id;
      user.data.id = id;
    }
    users_[id].seen_s = frame.time_s;
  }
}

void Users::TakeJoints(const tracker::Body& body, const UserWishes& requests, bool mirrored,
                       User& user) {
  NiteSkeleton& skeleton = user.data.skeleton;
  const bool wanted = requests.skeletons.count(user.data.id) > 0;
  if (!wanted) {
    ForgetJoints(skeleton);
    user.has_joints = false;
    return;
  }
  const bool asked_before = skeleton.state != NITE_SKELETON_NONE;
  if (!asked_before) skeleton.state = NITE_SKELETON_CALIBRATING;
  if (body.state != tracker::BodyState::kTracked) return;  // was requested only now
  const NiteSkeleton before = skeleton;
  FillJoints(body, mirrored, skeleton.joints);
  if (user.has_joints) Blend(before.joints, requests.smoothing, skeleton.joints);
  user.has_joints = true;
  if (asked_before && IsSure(body)) skeleton.state = NITE_SKELETON_TRACKED;
}

void Users::TakePoses(const tracker::Body& body, const Eigen::Vector3d& up,
                      const UserWishes& requests, User& user) {
  const auto wanted = requests.poses.find(user.data.id);
  for (const NitePoseType type : {NITE_POSE_PSI, NITE_POSE_CROSSED_HANDS}) {
    NitePoseData& pose = user.data.poses[type];
    pose = {type, 0};
    if (wanted == requests.poses.end() || wanted->second.count(type) == 0) {
      user.poses.erase(type);
      continue;
    }
    NitePoseState& state = user.poses.try_emplace(type, NITE_POSE_STATE_DETECTING).first->second;
    const bool known = body.state == tracker::BodyState::kTracked;
    const bool shown = known && ShowsPose(type, ToPosture(body), up, IsHeld(state));
    state = NextPoseState(state, shown);
    pose.state = state;
  }
}

std::vector<NiteUserData> Users::Step(const tracker::BodyFrame& frame,
                                      const std::vector<uint16_t>& depth_mm,
                                      const UserWishes& requests, bool mirrored) {
  if (mirrored != mirrored_) {
    for (auto& [id, user] : users_) user.has_joints = false;
  }
  mirrored_ = mirrored;
  AssignIds(frame);
  const auto boxes = FindBoxes(frame.users, depth_mm, mirrored);
  const Eigen::Vector3d up =
      frame.floor ? frame.floor->head<3>().eval() : Eigen::Vector3d(0.0, 1.0, 0.0);
  for (const tracker::Body& body : frame.bodies) {
    User& user = users_[UserOf(body.id)];
    const auto box = boxes.find(body.id);
    if (box != boxes.end()) user.data.boundingBox = box->second;
    user.data.centerOfMass = ToNite(body.position_m, mirrored);
    TakeJoints(body, requests, mirrored, user);
    TakePoses(body, up, requests, user);
  }
  std::vector<NiteUserData> all;
  for (auto at = users_.begin(); at != users_.end();) {
    User& user = at->second;
    const bool visible = IsInView(frame, user.body_id);
    const bool lost = frame.time_s - user.seen_s > kForget_s;
    if (!visible) {
      for (NiteSkeletonJoint& joint : user.data.skeleton.joints) {
        joint.positionConfidence = joint.orientationConfidence = 0.0F;
      }
    }
    if (lost) user.data.skeleton.state = NITE_SKELETON_NONE;
    user.data.state = lost ? NITE_USER_STATE_LOST : 0;
    if (visible) user.data.state = user.is_new ? NITE_USER_STATE_NEW : NITE_USER_STATE_VISIBLE;
    user.is_new = user.is_new && !visible;
    all.push_back(user.data);
    at = lost ? users_.erase(at) : std::next(at);
  }
  return all;
}

}  // namespace ossa::nite2
