#include "tools/stream/rest_bones.h"

#include <array>

namespace ossa::stream {
namespace {

using Eigen::Vector3d;

// Factor of the forearm's length: our hand joint's distance from the wrist. Derived from the
// joint cubes of MPFB's base mesh.
constexpr double kHandOfForearm = 0.213;

// Fingers by the same cubes: from the wrist on, each joint from the one before; along the hand, up,
// towards the thumb; unit: the hand joint's distance from the wrist.
struct Finger {
  const char* name;
  std::array<std::array<double, 3>, 3> joints;
};
constexpr std::array<Finger, 5> kFingers = {{
    {"Thumb", {{{0.69, -0.29, 0.45}, {0.37, -0.18, 0.36}, {0.59, -0.29, 0.35}}}},
    {"Index", {{{2.01, 0.01, 0.51}, {0.51, -0.05, 0.09}, {0.45, -0.13, 0.05}}}},
    {"Middle", {{{2.00, 0.00, 0.00}, {0.66, -0.03, -0.08}, {0.50, -0.12, -0.03}}}},
    {"Ring", {{{1.87, 0.04, -0.39}, {0.56, -0.01, -0.16}, {0.47, -0.11, -0.10}}}},
    {"Little", {{{1.68, 0.01, -0.77}, {0.41, -0.09, -0.15}, {0.26, -0.10, -0.09}}}},
}};
constexpr std::array<const char*, 3> kPhalanges = {"Proximal", "Intermediate", "Distal"};

// From the middle of the head; unit: from the neck to there. Eyes by MPFB's joint cubes; the jaw's
// hinge by hand, below the ears.
const Vector3d kEye(0.17, -0.23, 0.62);
const Vector3d kJaw(0.0, -0.38, 0.1);

/// The place for a side: Unity's left is -x.
Vector3d OnSide(double side, const Vector3d& place) {
  return {side * place.x(), place.y(), place.z()};
}

void AddFingers(const std::string& side_name, double side, double unit_m,
                std::vector<RestBone>& bones) {
  for (const Finger& finger : kFingers) {
    for (size_t k = 0; k < kPhalanges.size(); ++k) {
      const Vector3d place(finger.joints[k].data());
      bones.push_back({side_name + finger.name + kPhalanges[k], OnSide(side, unit_m * place)});
    }
  }
}

}  // namespace

std::vector<RestBone> MakeRestBones(const Humanoid& world) {
  using recon::Index;
  const auto length_m = [&](HumanBone from, HumanBone to) {
    return (world[Index(to)].position_m - world[Index(from)].position_m).norm();
  };
  const double head_m = length_m(HumanBone::kNeck, HumanBone::kHead);
  std::vector<RestBone> bones = {{"UpperChest", Vector3d::Zero()},
                                 {"LeftEye", OnSide(-1.0, head_m * kEye)},
                                 {"RightEye", OnSide(1.0, head_m * kEye)},
                                 {"Jaw", head_m * kJaw}};
  const double left_m = length_m(HumanBone::kLeftLowerArm, HumanBone::kLeftHand);
  const double right_m = length_m(HumanBone::kRightLowerArm, HumanBone::kRightHand);
  AddFingers("Left", -1.0, kHandOfForearm * left_m, bones);
  AddFingers("Right", 1.0, kHandOfForearm * right_m, bones);
  return bones;
}

}  // namespace ossa::stream
