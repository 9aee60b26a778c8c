#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/image/depth_frame.h"
#include "tools/nite2/hands.h"
#include "tools/tracker/tracker.h"

namespace ossa::nite2 {

// Constants: by hand.

/// Thresholds for hands without a body; by hand.
struct LoneHandOptions {
  int across = 160;          // cells across the width of the image
  double farthest_m = 1.5;   // farther people are in view from the waist up
  double jump_m = 0.04;      // depth from one cell to the next on one surface
  double arm_m = 0.35;       // radius of the search for the arm
  double hand_m = 0.17;      // from the finger tips to the wrist
  double least_m2 = 0.003;   // visible area of a fist or a hand edge-on
  double most_m2 = 0.04;     // visible area of a flat hand with spread fingers
  double most_cut = 0.35;    // share of its border where the surface continues: a wrist, not a wall
  double fastest_m_s = 3.0;  // speed of a hand
  double slack_m = 0.02;     // additional motion between frames
  double proven_s = 0.3;     // time tracked before its gestures count
  double near_m = 0.3;       // distance of a hand from its requested position
  double apart_m = 0.25;     // least distance between two hands
  double settle_s = 2.0;     // time constant with which the assumed shoulder follows the hand
  double reach_m = 0.5;      // from that shoulder to the hand, towards the sensor
  double above_m = 0.15;     // that shoulder above the hand's recent positions
};

/// Tracks hands without a detected body, by depth alone: of people of whom only an arm is in view,
/// or who are too near. A hand is the free end of a surface that continues only at a wrist, within
/// a hand's length. Objects of that shape are mistaken for hands.
class LoneHands {
 public:
  /// The hands of this frame, with negative body ids that stay constant. `of_bodies`: the hands of
  /// detected bodies, which are excluded; `asked_m`: positions in camera space, metres, where the
  /// program requested a hand.
  std::vector<SeenHand> Step(const depth::DepthFrame& image, const tracker::BodyFrame& bodies,
                             const std::vector<SeenHand>& of_bodies,
                             const std::vector<Eigen::Vector3d>& asked_m);

 private:
  struct Hand {
    int id = 0;
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d settled_m = Eigen::Vector3d::Zero();  // mean of recent positions
    double seen_s = 0.0, since_s = 0.0;
  };
  SeenHand UpdateHand(Hand& hand, const Eigen::Vector3d& place_m, const Eigen::Vector3d& elbow_m,
                      double time_s) const;

  LoneHandOptions options_;
  std::vector<Hand> hands_;
  int last_id_ = 0;
};

}  // namespace ossa::nite2
