#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "recon/posture.h"

namespace ossa::physics {

/// How a character follows its target.
enum class Control {
  kPaper,  // bounded PD forces on the joints and a bounded PD torque about each bone (the papers)
  kMotor,  // a servo motor in every ball joint and one that carries the trunk
};

/// One set of gains for all joints (Shum & Ho 2012 sec. 6, eqs. 1-2; Shum et al. 2013 eqs. 16-17).
///
/// The papers tune Ke and Kd by hand. Here both follow from one rate w. A force on joint i is
///   F_i = m_i (w^2 (p_target - p) + 2 w (v_target - v)),
/// with m_i the mass that hangs on the joint (LumpedMasses). If the bones' mass did sit in their
/// ends, each joint would follow its target as x'' = w^2 e + 2 w e', critically damped, whatever
/// the posture, because M = J^T diag(m) J on both sides. A real bone turns more easily than two
/// point masses (its radius of gyration k is below half its length L): its turning mode has
/// stiffness rho w^2 and damping 2 rho w with rho = (L/2k)^2 > 1, so its damping ratio is sqrt(rho)
/// >= 1. Hence no mode of the character is underdamped, with one w for all joints.
///
/// Explicit integration with step h is stable while (rho w^2) h^2 + 2 (2 rho w) h < 4; with the
/// largest rho of the segment table, 3.64 (shank), while w h < 0.257; LargestStableRate keeps to
/// 0.25.
struct ControlGains {
  double rate_rad_s = 35.0;              // w; chosen by a sweep on UI-PRMD and noisy mocap
  double max_acceleration_m_s2 = 250.0;  // |F_i| <= m_i times this
  /// |T_i| <= axial inertia times this.
  double max_angular_acceleration_rad_s2 = 2000.0;
};

/// How a character is built and controlled.
struct CharacterOptions {
  Control control = Control::kPaper;
  ControlGains gains;
  /// Share of the target's velocity that the controller uses, [0, 1]. 0: as if the newest posture
  /// stood still, smoothest. 1: no lag behind steady motion, as with the target's derivative in
  /// eq. 1, but with more noise.
  double lead = 0.0;
  bool pin_feet = true;
  /// Forearms, hands and legs go neither through each other nor through trunk and head. 3 cm of a
  /// limb are soft, as bodies are: a sensor's folded arms lie a little in the chest.
  bool self_collision = true;
  bool hinges = false;        // elbows and knees are hinges instead of ball joints (sec. 4)
  bool joint_limits = false;  // joints keep to human ranges of motion
  bool dodge = false;  // raise the forearms around the head when something flies at it (sec. 8.2)
  bool lean = false;   // lean out of the way of objects that fly at head or shoulders
  double stature_m = 0.0;  // 0: from the bones
  double mass_kg = 0.0;    // 0: from the stature
  /// Bit masks: two collide if each is in a group that the other collides with. By convention.
  uint32_t groups = 1, collides_with = ~0U;
  void Check(double step_s) const;
};

/// State of a character: joints in the world, metres.
struct CharacterState {
  recon::Posture posture;                // bone lengths exact
  recon::JointOrientations orientation;  // recon/orientation.h
  bool left_foot_pinned = false, right_foot_pinned = false;
  bool dodging = false;
  double max_anchor_gap_m = 0.0;  // between the two sides of a ball joint, now
  double max_solver_gap_m = 0.0;  // the same as the solver left it, largest of the last Step
  Eigen::Vector3d momentum_kg_m_s = Eigen::Vector3d::Zero();
  int rescued = 0;  // number of resets because its motion was not finite; should be 0
};

/// A posture at one time, for ComputeDynamics. Any right-handed frame, metres.
struct BodyPose {
  double time_s = 0.0;
  recon::Posture posture;                // of constant bone lengths, as a character's are
  recon::JointOrientations orientation;  // recon/orientation.h
};

/// Person, floor and smoothing of the derivatives in ComputeDynamics.
struct DynamicsOptions {
  double stature_m = 0.0, mass_kg = 0.0;         // as in CharacterOptions
  double gravity_m_s2 = 9.81;                    // Earth, by definition; along the normal
  Eigen::Vector4d floor = {0.0, 1.0, 0.0, 0.0};  // a b c d, normal up
  /// Velocities and accelerations are those of the parabola fitted to all frames within this time,
  /// at least three. 0.1 s lowers the acceleration of a swing of 1 Hz by 3 %.
  // By hand, [0, 1]; halves the acceleration of a swing of 4 Hz, biomechanics' usual low-pass
  // filter that of one of 6 Hz
  double window_s = 0.1;
};

/// Inverse dynamics at one time: newtons and newton metres, in the frame of the postures.
struct Dynamics {
  /// Muscle torque on the bone that ends in the joint, about the bone's other end: kAnkleLeft has
  /// the knee's torque, kKneeLeft the hip's, kWristLeft the elbow's. The spine, at which the chain
  /// ends, has the residual: zero, except in the air.
  recon::JointArray<Eigen::Vector3d> torque_nm;
  recon::JointArray<Eigen::Vector3d> force_n;  // on that bone at that end, by the bone before it
  Eigen::Vector3d ground_force_n = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> foot_force_n = {Eigen::Vector3d::Zero(),
                                                 Eigen::Vector3d::Zero()};  // left, right
  std::optional<Eigen::Vector3d> centre_of_pressure_m;  // on the floor; none in the air
  double free_moment_nm = 0.0;                          // of the ground, about the floor's normal
  Eigen::Vector3d centre_of_mass_m = Eigen::Vector3d::Zero();
};

/// Inverse dynamics of a recording (Winter 2009, chs. 5, 7): three or more frames in order of time.
/// Masses are those of de Leva 1996 (physics/anthropometry.h), with centres of mass in the middle
/// of the bones. The ground acts on the feet only. Two standing feet share its force as the centre
/// of pressure divides the distance between them; without force plates that is an assumption.
/// Throws InputError for frames, std::invalid_argument for options.
std::vector<Dynamics> ComputeDynamics(const recon::BoneLengths& lengths,
                                      std::span<const BodyPose> motion,
                                      const DynamicsOptions& options = {});

}  // namespace ossa::physics
