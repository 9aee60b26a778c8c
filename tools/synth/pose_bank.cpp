#include "tools/synth/pose_bank.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "recon/body/standard_body.h"
#include "recon/smallest_turn.h"
#include "tools/synth/random_posture.h"

namespace ossa::tools {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// First bone of each limb and how many bones follow it in a row (rig.h's order).
struct Chain {
  size_t first;
  size_t count;
};
constexpr Chain kArms[2] = {{18, 6}, {25, 6}};  // upper arm, forearm, hand, fingers, thumb
constexpr Chain kLegs[2] = {{2, 4}, {7, 4}};
constexpr size_t kCollar[2] = {17, 24};
constexpr size_t kSpine1 = 13, kNeck = 14;  // numbers of the rig's format (MPFB, cmu_mb)

double LargestMove_m(const recon::Posture& a, const recon::Posture& b) {
  double largest = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    largest = std::max(largest, (a.position_m[j] - b.position_m[j]).norm());
  }
  return largest;
}

uint64_t CellKey(const recon::Posture& posture, double cell_m) {
  uint64_t key = 1469598103934665603u;
  for (const auto& p : posture.position_m) {
    for (int c = 0; c < 3; ++c) {
      key = (key ^ static_cast<uint64_t>(std::llround(p[c] / cell_m) + 64)) * 1099511628211u;
    }
  }
  return key;
}

Vector3d AnyDirection(Random& random) {
  // Drawn in the order in which GCC once evaluated them as arguments: data sets stay the same.
  const double z = random.Normal(0, 1), y = random.Normal(0, 1), x = random.Normal(0, 1);
  const Vector3d v(x, y, z);
  return v.norm() > 1e-6 ? Vector3d(v.normalized()) : Vector3d::UnitX();
}

Quaterniond SmallTurn(double sigma_rad, Random& random) {
  const double angle_rad =
      std::clamp(random.Normal(0, sigma_rad), -2.5 * sigma_rad, 2.5 * sigma_rad);
  return Quaterniond(AngleAxisd(angle_rad, AnyDirection(random)));
}

void TurnBones(size_t first, size_t count, const Quaterniond& turn, recon::RigPose* pose) {
  for (size_t b = first; b < first + count; ++b) {
    pose->world_from_rest[b] = turn * pose->world_from_rest[b];
  }
}

Vector3d RestDirection(size_t bone) {
  const auto& rest = recon::StandardRigRest();
  return (rest.head_m[bone + 1] - rest.head_m[bone]).normalized();
}

void TurnHands(double sigma_rad, recon::RigPose* pose, Random& random) {
  for (const Chain& arm : kArms) {
    const Vector3d forearm = pose->world_from_rest[arm.first + 1] * RestDirection(arm.first + 1);
    const Quaterniond twist(AngleAxisd(random.Normal(0, 1.5 * sigma_rad), forearm));
    TurnBones(arm.first + 2, arm.count - 2, twist * SmallTurn(sigma_rad, random), pose);
  }
}

}  // namespace

// The upper arm in the half space outside of the trunk and in front, the
// elbow bent 0-145 degrees to a side that the shoulder's twist allows.
void RandomArm(size_t side, recon::RigPose* pose, Random& random) {
  const Chain arm = kArms[side];
  const double outwards = side == 0 ? 1.0 : -1.0;
  const Quaterniond trunk = pose->world_from_rest[kSpine1];
  Vector3d direction;
  do {
    direction = AnyDirection(random);
  } while (outwards * direction.x() < -0.45 || direction.z() < -0.5 ||
           (outwards * direction.x() < 0.1 && direction.z() < 0.25));
  const Quaterniond swing =
      recon::SmallestTurn(RestDirection(arm.first), direction) *
      Quaterniond(AngleAxisd(random.Uniform(-1.2, 1.2), RestDirection(arm.first)));
  // The elbow's axis is normal to upper arm and forearm at rest, where it is slightly bent.
  const Vector3d hinge = RestDirection(arm.first).cross(RestDirection(arm.first + 1)).normalized();
  const Quaterniond bend(AngleAxisd(random.Uniform(-0.6, 1.9), hinge));
  pose->world_from_rest[arm.first] = trunk * swing;
  for (size_t b = arm.first + 1; b < arm.first + arm.count; ++b) {
    pose->world_from_rest[b] = trunk * swing * bend;
  }
  // The collarbone rises with the arm, else the skin of the shoulder tears.
  const Quaterniond whole = recon::SmallestTurn(RestDirection(arm.first), direction);
  pose->world_from_rest[kCollar[side]] = trunk * Quaterniond::Identity().slerp(0.25, whole);
}

recon::RigPose Mirrored(const recon::RigPose& pose) {
  recon::RigPose mirrored = pose;
  mirrored.root_m.x() = -pose.root_m.x();
  for (size_t b = 0; b < recon::kRigBoneCount; ++b) {
    const bool left_leg = b >= 1 && b <= 5, right_leg = b >= 6 && b <= 10;
    const bool left_arm = b >= 17 && b <= 23, right_arm = b >= 24 && b <= 30;
    const size_t from = left_leg    ? b + 5
                        : right_leg ? b - 5
                        : left_arm  ? b + 7
                        : right_arm ? b - 7
                                    : b;
    // Mirroring at x = 0 keeps a rotation's x component and negates y and z.
    const Quaterniond& q = pose.world_from_rest[from];
    mirrored.world_from_rest[b] = Quaterniond(q.w(), q.x(), -q.y(), -q.z());
  }
  return mirrored;
}

recon::RigPose Turned(const recon::RigPose& pose, double angle_rad) {
  const Quaterniond turn(AngleAxisd(angle_rad, Vector3d::UnitY()));
  recon::RigPose turned = pose;
  turned.root_m = turn * pose.root_m;
  TurnBones(0, recon::kRigBoneCount, turn, &turned);
  return turned;
}

std::vector<recon::RigPose> MakePoseBank(const std::vector<recon::MotionClip>& clips,
                                         const PoseBankOptions& options) {
  std::vector<recon::RigPose> bank;
  std::unordered_map<uint64_t, int> alike;
  for (const auto& clip : clips) {
    bool first = true;
    recon::Posture last;
    for (const auto& frame : clip.frames) {
      const recon::RigPose pose = recon::WithoutHeading(frame);
      const recon::Posture posture = recon::StandardPosture(pose);
      if (!first && LargestMove_m(posture, last) < options.least_distance_m) continue;
      first = false;
      last = posture;
      if (alike[CellKey(posture, options.cell_m)]++ < options.most_alike) bank.push_back(pose);
    }
  }
  return bank;
}

std::optional<Poses> PosesFromName(std::string_view name) {
  if (name == "spread") return Poses::kSpread;
  if (name == "natural") return Poses::kNatural;
  if (name == "any") return Poses::kAny;
  return std::nullopt;
}

PoseBankOptions MakeBankOptions(Poses poses) {
  if (poses != Poses::kNatural) return {};
  return {.least_distance_m = 0.0, .most_alike = std::numeric_limits<int>::max()};
}

PoseVariation MakeVariation(Poses poses) {
  if (poses == Poses::kSpread) return {};
  if (poses == Poses::kAny) return {.random_posture_share = 0.25};
  return {.random_arm_share = 0.0, .perturbation_rad = 0.04};
}

recon::RigPose Varied(const recon::RigPose& from, const PoseVariation& variation, Random& random) {
  if (variation.random_posture_share > 0.0 && random.Chance(variation.random_posture_share)) {
    return RandomPosture(random);
  }
  recon::RigPose pose = random.Chance(variation.mirror_share) ? Mirrored(from) : from;
  const double sigma_rad = variation.perturbation_rad;
  for (size_t side = 0; side < 2; ++side) {
    TurnBones(kArms[side].first, kArms[side].count, SmallTurn(1.5 * sigma_rad, random), &pose);
    TurnBones(kArms[side].first + 1, kArms[side].count - 1, SmallTurn(sigma_rad, random), &pose);
    TurnBones(kLegs[side].first, kLegs[side].count, SmallTurn(0.6 * sigma_rad, random), &pose);
    TurnBones(kLegs[side].first + 1, kLegs[side].count - 1, SmallTurn(0.5 * sigma_rad, random),
              &pose);
  }
  TurnBones(kNeck, 3, SmallTurn(sigma_rad, random), &pose);
  TurnBones(kNeck + 1, 2, SmallTurn(1.5 * sigma_rad, random), &pose);
  if (random.Chance(variation.random_arm_share)) {
    const size_t which = random.Index(3);  // left, right, both
    for (size_t side = 0; side < 2; ++side) {
      if (which == side || which == 2) RandomArm(side, &pose, random);
    }
  }
  TurnHands(variation.wrist_rad, &pose, random);
  return pose;
}

}  // namespace ossa::tools
