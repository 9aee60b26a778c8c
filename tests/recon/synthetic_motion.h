#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "recon/database/posture_database.h"
#include "recon/normalise.h"

namespace ossa::recon::test {

/// The standard person with both arms raised sideways by an angle (0 hangs, pi / 2 level), forearms
/// bent forward by another, thighs forward and shanks back by a third, the feet under the hips;
/// HipCenter at the origin, facing +z.
inline Posture Gesture(double left_rad, double right_rad, double elbow_rad, double knee_rad = 0.0) {
  Posture p = StandardStance();
  const auto chain = [&](Joint from, const Eigen::Vector3d& direction) {
    const auto i = Index(from);
    p.position_m[i] = p.position_m[ParentOf(i)] + StandardBoneLengths()[i] * direction.normalized();
  };
  const auto arm = [&](Joint elbow, double side, double lift_rad) {
    const Eigen::Vector3d upper(side * std::sin(lift_rad), -std::cos(lift_rad), 0.0);
    const Eigen::Vector3d fore =
        std::cos(elbow_rad) * upper + std::sin(elbow_rad) * Eigen::Vector3d::UnitZ();
    chain(elbow, upper);
    chain(static_cast<Joint>(Index(elbow) + 1), fore);
    chain(static_cast<Joint>(Index(elbow) + 2), fore);
  };
  arm(Joint::kElbowLeft, 1.0, left_rad);
  arm(Joint::kElbowRight, -1.0, right_rad);
  for (const Joint knee : {Joint::kKneeLeft, Joint::kKneeRight}) {
    const Joint ankle = static_cast<Joint>(Index(knee) + 1);
    const Joint foot = static_cast<Joint>(Index(knee) + 2);
    chain(knee, {0.0, -std::cos(knee_rad), std::sin(knee_rad)});
    chain(ankle, {0.0, -std::cos(knee_rad), -std::sin(knee_rad)});
    chain(foot, {0.0, -0.2, 1.0});
  }
  const Eigen::Vector3d root = p[Joint::kHipCenter];
  for (auto& position : p.position_m) position -= root;
  return p;
}

/// A smooth gesture in time: arms and knees swing with different periods.
inline Posture Motion(double t_s) {
  return Gesture(0.9 + 0.8 * std::sin(1.3 * t_s), 0.9 + 0.8 * std::sin(0.9 * t_s + 1.0),
                 0.7 + 0.6 * std::sin(1.7 * t_s), 0.4 + 0.4 * std::sin(0.8 * t_s));
}

/// In front of the camera, facing it, scaled.
inline Posture InFrontOfCamera(const Posture& normalised, double scale = 1.0, double z_m = 2.5) {
  return Placed(Retargeted(normalised, ScaledBoneLengths(scale)), {{0.1, 0.2, z_m}, 3.1});
}

inline TrackedPosture AllTracked(const Posture& posture) {
  TrackedPosture tracked;
  tracked.posture = posture;
  tracked.state.fill(TrackingState::kTracked);
  tracked.confidence.fill(1.0);
  return tracked;
}

inline void AddNoise(Posture& posture, double sigma_m, std::mt19937_64& rng) {
  std::normal_distribution<double> normal(0.0, sigma_m);
  for (auto& p : posture.position_m) p += Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
}

/// Gestures over a grid of angles: a database of some hundred postures.
inline std::vector<PostureClip> GestureClips() {
  std::vector<PostureClip> clips;
  for (double knee = 0.0; knee <= 0.8; knee += 0.4) {
    PostureClip& clip = clips.emplace_back();
    clip.name = "gestures/" + std::to_string(clips.size());
    for (double left = 0.0; left < 1.9; left += 0.25) {
      for (double right = 0.0; right < 1.9; right += 0.25) {
        for (double elbow = 0.0; elbow < 1.4; elbow += 0.3) {
          clip.postures.push_back(Gesture(left, right, elbow, knee));
        }
      }
    }
  }
  return clips;
}

inline double MeanDistance_m(const Posture& a, const Posture& b) {
  double sum = 0.0;
  for (size_t i = 0; i < kJointCount; ++i) sum += (a.position_m[i] - b.position_m[i]).norm();
  return sum / kJointCount;
}

}  // namespace ossa::recon::test
