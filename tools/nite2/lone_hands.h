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
  int across = 160;          // cells from the image's left to its right that are looked at
  double farthest_m = 1.5;   // whoever stands farther off is in view from the waist up
  double jump_m = 0.04;      // depth from one cell to the next on one surface
  double arm_m = 0.35;       // radius in which the arm is looked for
  double hand_m = 0.17;      // from the finger tips to the wrist
  double least_m2 = 0.003;   // what is seen of a hand, fist or edge on
  double most_m2 = 0.04;     // ... and flat, fingers spread
  double most_cut = 0.35;    // share of its border where the surface goes on: a wrist, not a wall
  double fastest_m_s = 3.0;  // a hand on its way
  double slack_m = 0.02;     // between frames beyond that
  double proven_s = 0.3;     // how long it is followed before its gestures count
  double near_m = 0.3;       // how far from where it was asked for a hand may be
  double apart_m = 0.25;     // least way between two hands
  double settle_s = 2.0;     // in which the shoulder that is assumed follows the hand
  double reach_m = 0.5;      // from that shoulder to the hand, towards the sensor
  double above_m = 0.15;     // that shoulder above where the hand has been of late
};

/// Hands without a detected body, followed by depth alone: of a person of whom only an arm is in
/// view, or who stands too near. A hand is the free end of a surface that continues only at a wrist
/// within a hand's length. An object of that shape is mistaken for one.
class LoneHands {
 public:
  /// Those of this frame, with body ids below 0, the same from frame to frame. `of_bodies`: the
  /// other hands of the frame, at whose places there is no lone one; `asked_m`: places in camera
  /// space where a program says a hand is.
  std::vector<SeenHand> Step(const depth::DepthFrame& image, const tracker::BodyFrame& bodies,
                             const std::vector<SeenHand>& of_bodies,
                             const std::vector<Eigen::Vector3d>& asked_m);

 private:
  struct Hand {
    int id = 0;
    Eigen::Vector3d place_m;
    Eigen::Vector3d settled_m;  // where it has been of late
    double seen_s = 0.0, since_s = 0.0;
  };
  SeenHand UpdateHand(Hand& hand, const Eigen::Vector3d& place_m, const Eigen::Vector3d& elbow_m,
                      double time_s) const;

  LoneHandOptions options_;
  std::vector<Hand> hands_;
  int last_id_ = 0;
};

}  // namespace ossa::nite2
