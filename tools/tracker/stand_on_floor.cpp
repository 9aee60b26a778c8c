// From the ceiling a body occludes its own legs. Unseen legs that were not refined are placed
// standing on the floor.
#include <algorithm>
#include <cmath>

#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;

constexpr double kAnkle_m = 0.08;  // anthropometry: height of a standing ankle above the floor

struct Leg {
  Joint hip, knee, ankle, foot;
};
constexpr std::array kLegs = {
    Leg{Joint::kHipLeft, Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kFootLeft},
    Leg{Joint::kHipRight, Joint::kKneeRight, Joint::kAnkleRight, Joint::kFootRight}};

// The horizontal direction that the body faces; zero if undefined.
Vector3d EstimateFacing(const recon::Posture& posture, const Vector3d& up) {
  const Vector3d left = posture[Joint::kHipLeft] - posture[Joint::kHipRight] +
                        (posture[Joint::kShoulderLeft] - posture[Joint::kShoulderRight]);
  const Vector3d facing = left.cross(up);
  return facing.norm() > 1e-3 ? Vector3d(facing.normalized()) : Vector3d::Zero();
}

// Places the ankle on the floor below the hip, as far as the leg reaches, and the knee in front of
// the line between them if the leg is longer.
void Stand(const Leg& leg, const Vector3d& up, double height_m, const Vector3d& facing,
           recon::Posture& posture) {
  const Vector3d hip = posture[leg.hip];
  const double thigh_m = (posture[leg.knee] - hip).norm();
  const double shin_m = (posture[leg.ankle] - posture[leg.knee]).norm();
  const double foot_m = (posture[leg.foot] - posture[leg.ankle]).norm();
  const double reach_m = std::clamp(height_m - kAnkle_m, std::abs(thigh_m - shin_m) + 1e-3,
                                    std::max(thigh_m + shin_m, 2e-3));
  const double below_m =
      (thigh_m * thigh_m - shin_m * shin_m + reach_m * reach_m) / (2.0 * reach_m);
  const double ahead_m = std::sqrt(std::max(0.0, thigh_m * thigh_m - below_m * below_m));
  posture.position_m[recon::Index(leg.knee)] = hip - below_m * up + ahead_m * facing;
  posture.position_m[recon::Index(leg.ankle)] = hip - reach_m * up;
  const double drop_m = std::min(kAnkle_m, 0.5 * foot_m);
  posture.position_m[recon::Index(leg.foot)] =
      hip - (reach_m + drop_m) * up +
      std::sqrt(std::max(0.0, foot_m * foot_m - drop_m * drop_m)) * facing;
}

}  // namespace

void StandOnFloor(SkeletonWork& work) {
  if (!work.options.from_above || !work.floor) return;
  const bool starts_refined = recon::RequireMethod(work.options.reconstructor.method).refined;
  if (work.body.refined && starts_refined) return;
  const Vector3d up = work.floor->head<3>();
  const Vector3d facing = EstimateFacing(work.posture, up);
  const auto is_seen = [&](Joint joint) {
    return work.body.raw.state[recon::Index(joint)] == recon::TrackingState::kTracked;
  };
  for (const Leg& leg : kLegs) {
    if (is_seen(leg.knee) || is_seen(leg.ankle)) continue;
    Stand(leg, up, up.dot(work.posture[leg.hip]) + (*work.floor)[3], facing, work.posture);
    work.orientations.reset();  // recomputed from the joints
  }
}

}  // namespace ossa::tracker
