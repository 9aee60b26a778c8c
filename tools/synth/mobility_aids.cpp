#include "tools/synth/mobility_aids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depth/render/shapes.h"
#include "recon/body/standard_body.h"

namespace ossa::tools {
namespace {

// Constants: sizes of wheelchairs after ISO 7176-5 (seats 0.36 to 0.5 m wide, wheels of 24 inches,
// handles at 0.9 m), of crutches after ISO 11334-1; angles in degrees and the rest by hand; numbers
// of bones are the rig's.

using Eigen::Affine3f;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector3f;
using recon::Joint;

constexpr size_t kSpine1 = 13;
constexpr size_t kHip[2] = {1, 6};  // hip, thigh, shin, foot, toes follow each other

float Draw(Random& random, double low, double high) {
  return static_cast<float>(random.Uniform(low, high));
}

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

/// The person's left, up, and front over the floor.
struct Axes {
  Vector3f left, up, front;

  explicit Axes(const recon::Posture& joints) : up(Vector3f::UnitY()) {
    const Vector3f across = (joints[Joint::kHipLeft] - joints[Joint::kHipRight]).cast<float>();
    left = (across - across.dot(up) * up).normalized();
    front = left.cross(up);
  }
  /// Moves a mesh that was made with x to the left and z to the front.
  depth::TriangleMesh Put(const depth::TriangleMesh& mesh, const Vector3f& at_m) const {
    Affine3f frame = Affine3f::Identity();
    frame.linear() << left, up, front;
    frame.translation() = at_m;
    return depth::Moved(mesh, frame);
  }
};

depth::TriangleMesh Tube(const Vector3f& from_m, const Vector3f& to_m, float radius_m) {
  constexpr int kSegments = 8;
  const Vector3f way = to_m - from_m;
  const auto turn = Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitY(), way);
  return depth::Moved(depth::MakeCapsule(radius_m, way.norm(), kSegments),
                      Eigen::Translation3f((from_m + to_m) / 2) * turn * Affine3f::Identity());
}

/// A torus about the x axis.
depth::TriangleMesh Ring(float radius_m, float tube_m) {
  constexpr int kRound = 28;
  depth::TriangleMesh ring;
  const auto at = [&](int i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kRound;
    return Vector3f(0.0F, radius_m * std::sin(angle), radius_m * std::cos(angle));
  };
  for (int i = 0; i < kRound; ++i) depth::Append(ring, Tube(at(i), at(i + 1), tube_m));
  return ring;
}

/// A large wheel about the x axis with its hub at the origin; the hand rim is at +x.
depth::TriangleMesh Wheel(float radius_m) {
  constexpr int kSpokes = 12;
  depth::TriangleMesh wheel = Ring(radius_m, 0.017F);
  depth::Append(wheel, depth::Moved(Ring(radius_m - 0.03F, 0.01F),
                                    Affine3f(Eigen::Translation3f(0.04F, 0, 0))));
  depth::Append(wheel, Tube({-0.03F, 0, 0}, {0.03F, 0, 0}, 0.025F));
  for (int i = 0; i < kSpokes; ++i) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kSpokes;
    const Vector3f rim_m(0.0F, radius_m * std::sin(angle), radius_m * std::cos(angle));
    depth::Append(wheel, Tube(Vector3f::Zero(), rim_m, 0.003F));
  }
  return wheel;
}

/// Sizes of a chair, metres.
struct ChairSize {
  float width_m, deep_m, back_m, arm_m, wheel_m;
};

/// A chair on y = 0 with the hips over x = z = 0 and its seat at `seat_m`.
depth::TriangleMesh MakeWheelchair(const ChairSize& size, float seat_m) {
  constexpr float kBehind_m = 0.15F;  // from the hip centre to the backrest
  const float half_m = size.width_m / 2, front_m = size.deep_m - kBehind_m;
  const auto box = [](const Vector3f& size_m, const Vector3f& at_m) {
    return depth::Moved(depth::MakeBox(size_m), Affine3f(Eigen::Translation3f(at_m)));
  };
  depth::TriangleMesh chair =
      box({size.width_m, 0.04F, size.deep_m}, {0, seat_m - 0.02F, front_m - size.deep_m / 2});
  depth::Append(chair, box({size.width_m, size.back_m, 0.03F},
                           {0, seat_m + size.back_m / 2, -kBehind_m - 0.015F}));
  for (const float side : {-1.0F, 1.0F}) {
    const float x = side * (half_m + 0.02F), arm_m = seat_m + size.arm_m;
    depth::Append(chair, box({0.05F, 0.03F, 0.3F}, {x, arm_m, 0.02F}));
    depth::Append(chair, Tube({x, seat_m, 0.14F}, {x, arm_m, 0.14F}, 0.012F));
    const float top_m = std::max(seat_m + size.back_m, 0.88F);
    depth::Append(chair, Tube({x, seat_m, -kBehind_m}, {x, top_m, -kBehind_m - 0.03F}, 0.012F));
    depth::Append(chair,
                  Tube({x, top_m, -kBehind_m - 0.03F}, {x, top_m, -kBehind_m - 0.15F}, 0.016F));
    depth::TriangleMesh wheel = Wheel(size.wheel_m);
    if (side < 0) {
      wheel = depth::Moved(
          wheel, Affine3f(Eigen::AngleAxisf(std::numbers::pi_v<float>, Vector3f::UnitY())));
    }
    depth::Append(chair, depth::Moved(wheel, Affine3f(Eigen::Translation3f(side * (half_m + 0.06F),
                                                                           size.wheel_m, -0.06F))));
    const Vector3f castor_m(side * (half_m - 0.04F), 0.08F, front_m - 0.04F);
    depth::Append(chair,
                  depth::Moved(Ring(0.065F, 0.015F), Affine3f(Eigen::Translation3f(castor_m))));
    depth::Append(chair, Tube(castor_m, {castor_m.x(), seat_m, castor_m.z()}, 0.012F));
  }
  return chair;
}

/// A leg rest from the seat's corner to a footplate.
depth::TriangleMesh Footplate(const recon::Posture& joints, bool left, const Axes& axes,
                              const Vector3f& corner_m) {
  const Vector3f ankle_m = joints[left ? Joint::kAnkleLeft : Joint::kAnkleRight].cast<float>();
  const Vector3f toes_m = joints[left ? Joint::kFootLeft : Joint::kFootRight].cast<float>();
  Vector3f plate_m = (ankle_m + toes_m) / 2;
  plate_m.y() = 0.012F;
  depth::TriangleMesh plate = axes.Put(depth::MakeBox({0.14F, 0.012F, 0.17F}), plate_m);
  depth::Append(plate, Tube(corner_m, plate_m, 0.012F));
  return plate;
}

/// A pole with a handle at the hand, up to a cuff behind the forearm or to a pad under the arm.
depth::TriangleMesh MakeCrutch(const recon::Posture& joints, bool left, bool to_armpit,
                               const Vector3f& foot_m) {
  const auto at = [&](Joint of_left, Joint of_right) -> Vector3f {
    return joints[left ? of_left : of_right].cast<float>();
  };
  const Axes axes(joints);
  const Vector3f hand_m = at(Joint::kHandLeft, Joint::kHandRight);
  const Vector3f elbow_m = at(Joint::kElbowLeft, Joint::kElbowRight);
  const Vector3f forward = 0.06F * axes.front;
  depth::TriangleMesh crutch = Tube(hand_m - forward, hand_m + forward, 0.016F);
  if (to_armpit) {
    constexpr float kArmpit_m = 0.1F;  // below the shoulder joint
    const Vector3f pad_m = at(Joint::kShoulderLeft, Joint::kShoulderRight) - kArmpit_m * axes.up;
    for (const float side : {-1.0F, 1.0F}) {
      const Vector3f beside = side * 0.05F * axes.front;
      depth::Append(crutch, Tube(foot_m, hand_m + beside, 0.013F));
      depth::Append(crutch, Tube(hand_m + beside, pad_m + beside, 0.013F));
    }
    depth::Append(crutch, Tube(pad_m - 1.5F * forward, pad_m + 1.5F * forward, 0.025F));
    return crutch;
  }
  constexpr float kCuff = 0.75F;  // share of the way from the hand to the elbow
  constexpr float kSkin_m = 0.05F;
  const Vector3f cuff_m = hand_m + kCuff * (elbow_m - hand_m) - kSkin_m * axes.front;
  depth::Append(crutch, Tube(foot_m, hand_m, 0.013F));
  depth::Append(crutch, Tube(hand_m, cuff_m, 0.013F));
  depth::Append(crutch, Tube(cuff_m - 0.04F * axes.left, cuff_m + 0.04F * axes.left, 0.02F));
  return crutch;
}

}  // namespace

void SitDown(recon::RigPose* pose, Random& random) {
  auto& r = pose->world_from_rest;
  const Vector3d ahead = r[kSpine1] * Vector3d::UnitZ();
  const Quaterniond heading(Eigen::AngleAxisd(std::atan2(ahead.x(), ahead.z()), Vector3d::UnitY()));
  r[0] = heading * Turn(random.Uniform(-12, 4), Vector3d::UnitX());
  const double flex = random.Uniform(82, 96), knee = random.Uniform(62, 92);
  for (size_t side = 0; side < 2; ++side) {
    const double apart = (side == 0 ? 1.0 : -1.0) * random.Uniform(0, 12);
    const size_t hip = kHip[side];
    r[hip] = r[0];
    r[hip + 1] = heading * Turn(apart, Vector3d::UnitY()) * Turn(-flex, Vector3d::UnitX());
    r[hip + 2] = r[hip + 1] * Turn(knee, Vector3d::UnitX());
    r[hip + 3] = r[hip + 4] = heading * Turn(random.Uniform(-8, 8), Vector3d::UnitX());
  }
  constexpr double kSole_m = 0.08;  // below the ankle
  const recon::Posture sits = recon::StandardPosture(*pose);
  const double lowest_m = std::min(sits[Joint::kAnkleLeft].y(), sits[Joint::kAnkleRight].y());
  pose->root_m.y() += kSole_m - lowest_m;
}

bool HoldsCrutch(const recon::RigPose& pose) {
  const recon::Posture posture = recon::StandardPosture(pose);
  const auto in_chest = [&](Joint joint) -> Vector3d {
    return pose.world_from_rest[kSpine1].conjugate() *
           (posture[joint] - posture[Joint::kShoulderCenter]);
  };
  const Vector3d hand = in_chest(Joint::kHandLeft), elbow = in_chest(Joint::kElbowLeft);
  return hand.x() > 0.18 && hand.x() < 0.45 && hand.y() < -0.42 && hand.z() > 0.02 &&
         hand.z() < 0.3 && elbow.y() < -0.2 && hand.y() < elbow.y();
}

std::vector<Prop> SampleWheelchair(const recon::Posture& joints_in_world, Random& random) {
  constexpr float kFlesh_m = 0.1F;  // from the hip joints to the seat
  const float width_m = Draw(random, 0.38, 0.5), deep_m = Draw(random, 0.38, 0.46);
  const float back_m = Draw(random, 0.32, 0.5), arm_m = Draw(random, 0.18, 0.26);
  const ChairSize size{width_m, deep_m, back_m, arm_m, Draw(random, 0.27, 0.31)};
  const Axes axes(joints_in_world);
  Vector3f hips_m =
      ((joints_in_world[Joint::kHipLeft] + joints_in_world[Joint::kHipRight]) / 2).cast<float>();
  const float seat_m = std::max(0.3F, hips_m.y() - kFlesh_m);
  hips_m.y() = 0.0F;
  depth::TriangleMesh chair = axes.Put(MakeWheelchair(size, seat_m), hips_m);
  for (const bool left : {true, false}) {
    const float aside_m = (left ? 0.5F : -0.5F) * (width_m - 0.06F);
    const Vector3f corner_m =
        hips_m + aside_m * axes.left + seat_m * axes.up + (deep_m - 0.15F) * axes.front;
    depth::Append(chair, Footplate(joints_in_world, left, axes, corner_m));
  }
  std::vector<Prop> props(1);
  props[0].mesh_in_cam = std::move(chair);
  return props;
}

std::vector<Prop> SampleCrutches(const recon::Posture& joints_in_world, Random& random) {
  const bool both = random.Chance(0.75), left_only = random.Chance(0.5);
  const bool to_armpit = random.Chance(0.3);
  const float aside_m = Draw(random, 0.0, 0.15), ahead_m = Draw(random, -0.05, 0.3);
  const Axes axes(joints_in_world);
  std::vector<Prop> props;
  for (const bool left : {true, false}) {
    if (!both && left != left_only) continue;
    const Joint hand = left ? Joint::kHandLeft : Joint::kHandRight;
    Vector3f foot_m = joints_in_world[hand].cast<float>() + ahead_m * axes.front +
                      (left ? aside_m : -aside_m) * axes.left;
    foot_m.y() = 0.015F;
    props.push_back({MakeCrutch(joints_in_world, left, to_armpit, foot_m), true,
                     left ? Grip::kLeftHand : Grip::kRightHand});
  }
  return props;
}

}  // namespace ossa::tools
