#include "physics/control_internal.h"

#include <algorithm>

namespace ossa::physics {

double LargestStableRate(double h_s) {
  // No unit; below the bound of the discrete system, 0.257 (derived in character.h)
  constexpr double kLargestRateTimesStep = 0.25;
  return kLargestRateTimesStep / h_s;
}

// `stiffness` in (0, 1] slows joints of lower trust: it scales w, so damping stays critical.
Eigen::Vector3d ControlForce(const ControlGains& gains, double stiffness, double mass_kg,
                             const Eigen::Vector3d& position_error_m,
                             const Eigen::Vector3d& velocity_error_m_s) {
  const double w = gains.rate_rad_s * stiffness;
  Eigen::Vector3d acceleration = w * w * position_error_m + 2.0 * w * velocity_error_m_s;
  const double norm = acceleration.norm();
  if (norm > gains.max_acceleration_m_s2) acceleration *= gains.max_acceleration_m_s2 / norm;
  return mass_kg * acceleration;
}

double ControlTorque(const ControlGains& gains, double stiffness, double axial_inertia_kgm2,
                     double angle_error_rad, double rate_error_rad_s) {
  const double w = gains.rate_rad_s * stiffness;
  const double acceleration = w * w * angle_error_rad + 2.0 * w * rate_error_rad_s;
  return axial_inertia_kgm2 * std::clamp(acceleration, -gains.max_angular_acceleration_rad_s2,
                                         gains.max_angular_acceleration_rad_s2);
}

}  // namespace ossa::physics
