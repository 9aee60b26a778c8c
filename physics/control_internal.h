#pragma once
#include "physics/character.h"

namespace ossa::physics {

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
