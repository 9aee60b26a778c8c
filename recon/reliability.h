#pragma once
#include <array>
#include <deque>
#include <optional>

#include "depth/image/depth_frame.h"
#include "recon/bone_lengths.h"
#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

// Constants: Shum 2013 where an equation is said; ours chosen by hand on rendered people (`ossa
// experiment shum-2013`). Without another unit they are ratios.

/// Shum et al. 2013, section IV: how far each joint of an observed posture may be believed.
struct ReliabilityOptions {
  bool use_behaviour = true;   // Rb, eqs. 1-4: vibration
  bool use_kinematics = true;  // Rk, eqs. 5-6: bone lengths against the reference
  bool use_state = true;       // Rt, eq. 7: what the tracker itself says
  // Departure, ours: is there a surface where the joint is said to be? Without a depth image
  // (files, the studies of the papers) the terms are the papers' three.
  bool use_depth = true;
  // Departure, ours, off for the papers' methods: a joint that leaves its bone faster than people
  // move. One wrong frame is too short for the vibration of eq. 4, and may keep the bone's length.
  bool use_speed = false;
  double d_min_m = 0.03;                  // d_min of eq. 3, metres
  double floor_rad = 1.5707963267948966;  // theta_floor of eq. 4: 90 degrees
  double roof_rad = 2.356194490192345;    // theta_roof of eq. 4: 135 degrees
  int behaviour_frames = 3;               // f_b of eq. 4
  int window_frames = 6;                  // f_total of eq. 8
  double window_sigma_frames = 2.0;       // of w(f), eq. 8; the paper gives none
  double surface_behind_m = 0.25;         // a joint lies at most this far behind the skin it is in
  double surface_before_m = 0.08;         // a joint in free space: the surface is this much farther
  double usual_speed = 5.0;               // m/s about the next joint: a thrower's arm
  double no_speed = 8.0;                  // m/s about the next joint that nobody reaches
};

/// The terms of one frame and the smoothed rate.
struct Reliability {
  JointWeights behaviour{};   // Rb
  JointWeights kinematics{};  // Rk
  JointWeights state{};       // Rt
  JointWeights surface{};     // ours; 1 where the image cannot tell
  JointWeights speed{};       // ours; 1 where it is not used
  JointWeights instant{};     // min of the above, this frame only
  JointWeights rate{};        // R_i of eq. 8
};

/// Limits of the reference lengths; anthropometry and sensors' definitions of joints, with a
/// margin.
struct ReferenceLengthOptions {
  // Over the standard body's bones at the person's size: joints are defined differently by every
  // sensor, but not by more.
  double shortest = 0.5, longest = 2.0;
  int fewest_joints = 8;         // fewer do not fix a size
  double tracked = 0.99;         // a joint with so much trust is tracked, [0, 1]
  double present = 0.5;          // ... with more than that is there
  double other_size = 0.2;       // relative: a body of that other size is another person's
  double other_length = 0.15;    // relative: a length so far from the reference is an error
  double upright_deg = 20.0;     // of trunk and legs in a reference posture
  double level_arms_deg = 25.0;  // of arms from the horizontal in a T-pose
  // Of hanging arms, from pointing up: upper arms hang, forearms may be bent forward.
  double hanging_upper_deg = 145.0, hanging_lower_deg = 130.0;
};

/// Reference bone lengths of eq. 5: taken whenever a T-pose or a standing posture is seen with
/// every joint tracked that the sensor has; until then the mean of what was seen.
class ReferenceLengths {
 public:
  void Observe(const Posture& in_camera, const JointWeights& trust);
  double length_m(size_t bone) const {
    return from_posture_ ? of_reference_.length_m(bone) : before_reference_.length_m(bone);
  }
  bool known() const { return known_; }

 private:
  void FromReferencePosture(const BoneLengths& lengths, const JointWeights& trust);
  void FromAnyPosture(const BoneLengths& lengths, const JointWeights& trust);

  ReferenceLengthOptions options_;
  BoneLengthEstimator before_reference_{BoneLengthOptions::BeforeReference()};
  BoneLengthEstimator of_reference_{BoneLengthOptions::ForReferencePostures()};
  JointArray<bool> had_{};     // joints that were ever tracked
  double scale_ = 1.0;         // of the last reference posture, or of the first frame
  bool known_ = false;         // some frame was good enough to measure at least the size
  bool from_posture_ = false;  // a reference posture was seen
};

/// True for the two reference postures of fig. 2: upright trunk and legs, arms level or hanging.
bool IsReferencePosture(const Posture& in_camera, const ReferenceLengthOptions& options = {});

/// Ours: which joints move as a person's can about the next joint up that does, or about the whole
/// body, since they were last believed to. What stays where it jumped to is believed once a limb
/// could have come there; what comes back was never gone.
class SpeedTerm {
 public:
  SpeedTerm() { unbelieved_s_.fill(-1.0); }
  /// 1 up to the usual speed, 0 from that on which nobody reaches.
  JointWeights Step(const Posture& posture, const JointWeights& seen, double dt_s,
                    const ReliabilityOptions& options);

 private:
  Eigen::Vector3d BodyMoved(const Posture& posture, const JointWeights& seen) const;

  Posture believed_;  // where each joint was, or would be now had it stayed on its bone
  JointArray<double> unbelieved_s_{};  // for how long; < 0: it was never believed
};

/// One person's reliability, frame by frame. Joints that are not finite count as not tracked.
class ReliabilityEstimator {
 public:
  explicit ReliabilityEstimator(const ReliabilityOptions& options = {}) : options_(options) {}
  /// `camera_from_observed`: from the observed joints' space to that of `depth`, if another.
  Reliability Step(const TrackedPosture& observed, const depth::DepthFrame* depth,
                   double dt_s = 1.0 / 30.0,
                   const std::optional<Eigen::Isometry3d>& camera_from_observed = std::nullopt);
  /// Forgets the person.
  void Reset();
  /// Forgets how the person moved, not the reference lengths: after a gap it is the same person.
  void ForgetMotion();
  const ReferenceLengths& reference() const { return reference_; }

 private:
  JointWeights Behaviour() const;
  JointWeights Kinematics(const Posture& posture, const JointWeights& seen) const;
  JointWeights Smoothed() const;

  ReliabilityOptions options_;
  ReferenceLengths reference_;
  std::deque<Posture> postures_;      // newest last
  std::deque<JointWeights> seen_;     // 1 where the joint of that frame is a finite observation
  std::deque<JointWeights> instant_;  // newest last
  SpeedTerm speed_;
};

/// Ours: what the depth image says of joints at these positions. A surface close in front of the
/// joint: 1. A surface much nearer: the joint is hidden, 0. Surface farther, or none: the joint is
/// said to float in the air, 0. Outside the image or without a reading: 1, it cannot tell.
JointWeights SurfaceReliability(const Posture& in_camera, const depth::DepthFrame& depth,
                                const ReliabilityOptions& options = {});

}  // namespace ossa::recon
