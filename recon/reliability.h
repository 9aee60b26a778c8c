#pragma once
#include <array>
#include <deque>
#include <optional>

#include "depth/image/depth_frame.h"
#include "recon/bone_lengths.h"
#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

// Constants: Shum 2013 where an equation is stated; ours chosen by hand on rendered people (`ossa
// experiment shum-2013`). Without another unit they are ratios.

/// Shum et al. 2013, section IV: reliability of each joint of an observed posture.
struct ReliabilityOptions {
  bool use_behaviour = true;   // Rb, eqs. 1-4: vibration
  bool use_kinematics = true;  // Rk, eqs. 5-6: bone lengths against the reference
  bool use_state = true;       // Rt, eq. 7: the tracking state
  // Departure, ours: whether the depth image has a surface at the joint. Without a depth image
  // (files, the studies of the papers) there are only the paper's three terms.
  bool use_depth = true;
  // Departure, ours, off for the papers' methods: a joint that moves faster relative to its parent
  // than people can. Eq. 4 does not detect a single wrong frame, which may keep the bone's length.
  bool use_speed = false;
  double d_min_m = 0.03;                  // d_min of eq. 3, metres
  double floor_rad = 1.5707963267948966;  // theta_floor of eq. 4: 90 degrees
  double roof_rad = 2.356194490192345;    // theta_roof of eq. 4: 135 degrees
  int behaviour_frames = 3;               // f_b of eq. 4
  int window_frames = 6;                  // f_total of eq. 8
  double window_sigma_frames = 2.0;       // of w(f), eq. 8; the paper gives none
  double surface_behind_m = 0.25;         // largest depth of a joint behind its skin
  double surface_before_m = 0.08;  // a joint is in free space if the surface is this far behind
  double usual_speed = 5.0;        // m/s relative to the parent: a thrower's arm
  double no_speed = 8.0;           // m/s relative to the parent that nobody reaches
};

/// The terms of one frame and the smoothed reliability, [0, 1].
struct Reliability {
  JointWeights behaviour{};   // Rb
  JointWeights kinematics{};  // Rk
  JointWeights state{};       // Rt
  JointWeights surface{};     // ours; 1 where the image cannot tell
  JointWeights speed{};       // ours; 1 where it is not used
  JointWeights instant{};     // minimum of the above, of this frame only
  JointWeights rate{};        // R_i of eq. 8
};

/// Limits of the reference lengths, from anthropometry and sensors' definitions of joints, with a
/// margin.
struct ReferenceLengthOptions {
  // Ratios to the standard body's bones at the person's size: sensors define joints differently,
  // but not by more.
  double shortest = 0.5, longest = 2.0;
  int fewest_joints = 8;         // fewer do not determine the size
  double tracked = 0.99;         // a joint of this weight is tracked, [0, 1]
  double present = 0.5;          // ... of more than this is present
  double other_size = 0.2;       // relative: from this difference of size on it is another person
  double other_length = 0.15;    // relative: from this difference on a length is an error
  double upright_deg = 20.0;     // of trunk and legs in a reference posture
  double level_arms_deg = 25.0;  // of arms from the horizontal in a T-pose
  // Of hanging arms, from pointing up: upper arms hang, forearms may be bent forward.
  double hanging_upper_deg = 145.0, hanging_lower_deg = 130.0;
};

/// Reference bone lengths of eq. 5: measured in each T-pose or standing posture in which every
/// joint that the sensor has is tracked; before the first one, the mean of all frames.
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

/// Ours: whether a joint's motion since it was last reliable is possible, relative to its nearest
/// ancestor whose motion is, or to the whole body. A joint that stays where it jumped to is
/// reliable again once a limb could have moved there; one that comes back is reliable at once.
class SpeedTerm {
 public:
  SpeedTerm() { unbelieved_s_.fill(-1.0); }
  /// 1 up to usual_speed, falling to 0 at no_speed.
  JointWeights Step(const Posture& posture, const JointWeights& seen, double dt_s,
                    const ReliabilityOptions& options);

 private:
  Eigen::Vector3d BodyMoved(const Posture& posture, const JointWeights& seen) const;

  Posture believed_;  // where each joint was, or would be now had it stayed on its bone
  JointArray<double> unbelieved_s_{};  // for how long; < 0: it was never believed
};

/// Reliability of one person's joints, frame by frame. Joints at impossible places
/// (IsPossiblePlace) count as not tracked.
class ReliabilityEstimator {
 public:
  explicit ReliabilityEstimator(const ReliabilityOptions& options = {}) : options_(options) {}
  /// `camera_from_observed`: transform of the joints to the space of `depth`, if it is another.
  Reliability Step(const TrackedPosture& observed, const depth::DepthFrame* depth,
                   double dt_s = 1.0 / 30.0,
                   const std::optional<Eigen::Isometry3d>& camera_from_observed = std::nullopt);
  /// Forgets the person.
  void Reset();
  /// Forgets the motion, not the reference lengths: for a gap after which it is the same person.
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

/// Ours: reliability of joints at these positions by the depth image. 1 with a surface close in
/// front of the joint; 0 with a surface much nearer, which hides it; 0 with a surface farther away,
/// so that the joint would be in free space; 1 outside the image or without a reading.
JointWeights SurfaceReliability(const Posture& in_camera, const depth::DepthFrame& depth,
                                const ReliabilityOptions& options = {});

}  // namespace ossa::recon
