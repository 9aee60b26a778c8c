#pragma once
#include <NiteCTypes.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "tools/nite2/gestures.h"
#include "tools/tracker/tracker.h"

namespace ossa::nite2 {

// Constants: by hand.

/// A hand in view.
struct SeenHand {
  int body_id = 0;          // below 0: one without a body
  bool left = false;        // unknown and false without a body
  HandSample sample;        // camera space
  bool moves_count = true;  // whether its motion counts for gestures
};

/// The tracked and inferred hands of all people in the frame.
std::vector<SeenHand> CollectHands(const tracker::BodyFrame& frame);

/// Options of hand tracking; by hand.
struct HandOptions {
  double near_m = 0.3;      // distance of a hand from its requested position
  double patience_s = 0.5;  // time out of sight after which a hand is lost
  double border = 0.05;  // fraction of the image's width from its border on that counts as touching
};

/// Hands followed by id, as requested by a program.
class FollowedHands {
 public:
  /// An id for a hand near this position, in camera space; the next step searches for it.
  NiteHandId Start(const Eigen::Vector3d& place_m);
  void Stop(NiteHandId id) { hands_.erase(id); }
  void StopAll() { hands_.clear(); }
  /// Positions of requested hands that were not found yet, camera space.
  std::vector<Eigen::Vector3d> WaitedFor() const;

  /// All hands after a frame; a lost one is returned once more. `smoothing`: weight of the previous
  /// position, [0, 1].
  std::vector<NiteHandData> Step(const std::vector<SeenHand>& seen, double time_s,
                                 const depth::Camera& camera, float smoothing, bool mirrored);

 private:
  struct Hand {
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    std::optional<int> body_id;  // none: not met yet
    bool left = false;
    double seen_s = 0.0;
  };
  const SeenHand* Find(const Hand& hand, const std::vector<SeenHand>& seen) const;
  int Follow(Hand& hand, const std::vector<SeenHand>& seen, double time_s,
             const depth::Camera& camera, double smoothing) const;

  HandOptions options_;
  std::map<NiteHandId, Hand> hands_;
  NiteHandId last_id_ = 0;
};

/// The gestures of all hands in view.
class GestureWatch {
 public:
  std::vector<NiteGestureData> Step(const std::vector<SeenHand>& seen,
                                    const std::set<NiteGestureType>& wanted, bool mirrored);

 private:
  std::map<std::tuple<int, bool, NiteGestureType>, GestureDetector> detectors_;
};

}  // namespace ossa::nite2
