#pragma once
#include <Eigen/Core>

namespace ossa::physics {

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
/// largest rho of the segment table, 3.65 (shank), while w h < 0.256; LargestStableRate keeps to
/// 0.25.
struct ControlGains {
  double rate_rad_s = 35.0;              // w; chosen by a sweep on UI-PRMD and noisy mocap
  double max_acceleration_m_s2 = 250.0;  // |F_i| <= m_i times this
  /// |T_i| <= axial inertia times this.
  double max_angular_acceleration_rad_s2 = 2000.0;
};

/// Largest rate that is stable at a step of h seconds, by the derivation above.
double LargestStableRate(double h_s);

/// Eq. 1 / 16, bounded.
Eigen::Vector3d ControlForce(const ControlGains& gains, double stiffness, double mass_kg,
                             const Eigen::Vector3d& position_error_m,
                             const Eigen::Vector3d& velocity_error_m_s);

/// Eq. 2 / 17, bounded: about the segment's own axis.
double ControlTorque(const ControlGains& gains, double stiffness, double axial_inertia_kgm2,
                     double angle_error_rad, double rate_error_rad_s);

}  // namespace ossa::physics
