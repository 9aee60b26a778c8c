#pragma once
#include <NiteCTypes.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "tools/nite2/poses.h"
#include "tools/tracker/tracker.h"

namespace ossa::nite2 {

/// Requests of a program, by NiteUserId.
struct UserWishes {
  std::set<NiteUserId> skeletons;
  std::map<NiteUserId, std::set<NitePoseType>> poses;
  float smoothing = 0.0F;  // weight of a joint's previous position, [0, 1]
};

/// The people of a tracker as NiTE's users: small ids, which are free again ten seconds after a
/// person has left, and the state of each from frame to frame.
class Users {
 public:
  /// All users after a frame, by id. `depth_mm`: the frame's image, not mirrored, row-major as
  /// `frame.users`.
  std::vector<NiteUserData> Step(const tracker::BodyFrame& frame,
                                 const std::vector<uint16_t>& depth_mm, const UserWishes& requests,
                                 bool mirrored);

  /// The user of a body; 0 of none.
  NiteUserId UserOf(int body_id) const;
  /// The bodies whose joints are wanted.
  std::vector<int> BodiesWanted(const UserWishes& requests) const;
  bool Has(NiteUserId id) const { return users_.count(id) > 0; }

 private:
  struct User {
    int body_id = 0;
    double seen_s = 0.0;
    bool is_new = true;
    NiteUserData data{};
    std::map<NitePoseType, NitePoseState> poses;
    bool has_joints = false;  // of a frame before, for smoothing
  };

  void AssignIds(const tracker::BodyFrame& frame);
  void TakeJoints(const tracker::Body& body, const UserWishes& requests, bool mirrored, User& user);
  void TakePoses(const tracker::Body& body, const Eigen::Vector3d& up, const UserWishes& requests,
                 User& user);

  std::map<NiteUserId, User> users_;
  bool mirrored_ = false;
};

}  // namespace ossa::nite2
