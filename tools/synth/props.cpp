#include "tools/synth/props.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "depth/render/shapes.h"
#include "recon/smallest_turn.h"

namespace ossa::tools {
namespace {

using Eigen::Affine3f;
using Eigen::Vector3f;
using recon::Joint;

float Draw(Random& random, double low, double high) {
  return static_cast<float>(random.Uniform(low, high));
}

// Random draws are named or in braces, because the order in which a call's arguments are evaluated
// is unspecified. The orders are those of GCC when they were arguments: data sets stay the same.

Eigen::Quaternionf AnyRotation(Random& random) {
  const double z = random.Normal(0, 1), y = random.Normal(0, 1);
  const double x = random.Normal(0, 1), w = random.Normal(0, 1);
  return Eigen::Quaterniond(w, x, y, z).cast<float>().normalized();
}

/// An object held in one hand, its grip near the origin.
depth::TriangleMesh SmallThing(Random& random) {
  switch (random.Index(4)) {
    case 0:
      return depth::MakeBall(Draw(random, 0.04, 0.13));
    case 1:
      return depth::MakeBox(
          {Draw(random, 0.05, 0.25), Draw(random, 0.05, 0.35), Draw(random, 0.02, 0.2)});
    case 2: {  // a stick, bat or racket handle, held near its end
      const float length_m = Draw(random, 0.3, 1.1);
      const float above_m = Draw(random, 0.2, 0.5) * length_m;
      const float radius_m = Draw(random, 0.012, 0.035);
      return depth::Moved(depth::MakeCapsule(radius_m, length_m),
                          Affine3f(Eigen::Translation3f(0, above_m, 0)));
    }
    default: {  // a bag or bottle, hanging below the hand
      const float above_m = Draw(random, -0.35, -0.1);
      return depth::Moved(depth::MakeBox({Draw(random, 0.08, 0.4), Draw(random, 0.15, 0.45),
                                          Draw(random, 0.06, 0.2)}),
                          Affine3f(Eigen::Translation3f(0, above_m, 0)));
    }
  }
}

/// A bulky object carried between both hands.
depth::TriangleMesh LargeThing(float span_m, Random& random) {
  const float width_m = std::clamp(span_m, 0.12F, 0.7F);
  if (random.Chance(0.3)) return depth::MakeBall(width_m / 2);
  return depth::MakeBox({width_m, Draw(random, 0.1, 0.6), Draw(random, 0.02, 0.4)});
}

Prop HeldInOneHand(const recon::Posture& joints, Random& random) {
  const bool left = random.Chance(0.5);
  const Vector3f hand_m = joints[left ? Joint::kHandLeft : Joint::kHandRight].cast<float>();
  const Eigen::Quaternionf turn = AnyRotation(random);
  return {
      depth::Moved(SmallThing(random), Eigen::Translation3f(hand_m) * turn * Affine3f::Identity()),
      true, left ? Grip::kLeftHand : Grip::kRightHand};
}

/// Pose of an object between the hands, rotated with the line between them.
Prop HeldInBothHands(const recon::Posture& joints, Random& random) {
  const Vector3f left_m = joints[Joint::kHandLeft].cast<float>();
  const Vector3f right_m = joints[Joint::kHandRight].cast<float>();
  const Vector3f across = left_m - right_m;
  const Eigen::Quaternionf turn = recon::SmallestTurn(Vector3f::UnitX(), across) *
                                  Eigen::AngleAxisf(Draw(random, -3.1, 3.1), Vector3f::UnitX());
  return {depth::Moved(LargeThing(across.norm(), random),
                       Eigen::Translation3f((left_m + right_m) / 2) * turn * Affine3f::Identity()),
          true, Grip::kBothHands};
}

double Span_m(const recon::Posture& joints) {
  return (joints[Joint::kHandLeft] - joints[Joint::kHandRight]).norm();
}

/// `widest_m`: the largest distance between the hands.
Prop Held(const recon::Posture& joints, double widest_m, Random& random) {
  return widest_m < 0.8 && random.Chance(0.5) ? HeldInBothHands(joints, random)
                                              : HeldInOneHand(joints, random);
}

/// An occluder on the floor, or at some height, between the person and the camera.
Prop StandingBefore(const recon::Posture& joints, const Eigen::Isometry3d& camera_from_world,
                    Random& random) {
  const Eigen::Vector3d camera_m = camera_from_world.inverse().translation();
  const Eigen::Vector3d person_m = joints[Joint::kHipCenter];
  Eigen::Vector3d way = camera_m - person_m;
  way.y() = 0.0;
  const double distance_m = way.norm();
  const double before_m = std::min(random.Uniform(0.3, 1.0), 0.6 * distance_m);
  const Eigen::Vector3d side = Eigen::Vector3d::UnitY().cross(way.normalized());
  const Eigen::Vector3d place_m =
      person_m + way.normalized() * before_m + side * random.Uniform(-0.5, 0.5);
  Vector3f foot_m(static_cast<float>(place_m.x()), 0.0F, static_cast<float>(place_m.z()));
  depth::TriangleMesh mesh;
  switch (random.Index(4)) {
    case 0:
      mesh = depth::MakeTable(
          {Draw(random, 0.5, 1.4), Draw(random, 0.4, 0.95), Draw(random, 0.4, 0.8)});
      break;
    case 1: {
      const float back_m = Draw(random, 0.3, 0.6), width_m = Draw(random, 0.38, 0.55);
      mesh = depth::MakeChair(Draw(random, 0.38, 0.5), width_m, back_m);
      break;
    }
    case 2:  // a board, or a pillar, upright
      mesh = depth::MakeBox({Draw(random, 0.08, 0.7), Draw(random, 0.3, 1.5), 0.03F});
      foot_m.y() = Draw(random, 0.2, 1.2);
      break;
    default:
      mesh =
          depth::MakeBox({Draw(random, 0.2, 0.7), Draw(random, 0.2, 1.0), Draw(random, 0.2, 0.6)});
      foot_m.y() = Draw(random, 0.2, 0.5);
  }
  const auto turn = Eigen::AngleAxisf(Draw(random, -3.1, 3.1), Vector3f::UnitY());
  return {
      depth::Moved(std::move(mesh), Eigen::Translation3f(foot_m) * turn * Affine3f::Identity())};
}

/// Place of a grip, and the line that rotates with it.
struct Grasp {
  Vector3f place_m, along;
};

Grasp ComputeGrasp(Grip grip, const recon::Posture& joints) {
  const auto at = [&](Joint joint) -> Vector3f { return joints[joint].cast<float>(); };
  switch (grip) {
    case Grip::kLeftHand:
      return {at(Joint::kHandLeft), at(Joint::kHandLeft) - at(Joint::kElbowLeft)};
    case Grip::kRightHand:
      return {at(Joint::kHandRight), at(Joint::kHandRight) - at(Joint::kElbowRight)};
    case Grip::kBothHands:
      return {(at(Joint::kHandLeft) + at(Joint::kHandRight)) / 2,
              at(Joint::kHandLeft) - at(Joint::kHandRight)};
    case Grip::kNone:
      break;
  }
  return {Vector3f::Zero(), Vector3f::Zero()};
}

Eigen::AlignedBox2f ProjectOnGround(const depth::TriangleMesh& mesh) {
  Eigen::AlignedBox2f ground;
  for (const auto& vertex_m : mesh.vertices_m)
    ground.extend(Eigen::Vector2f(vertex_m.x(), vertex_m.z()));
  return ground;
}

/// Bounding box on the floor plan of everything that the person may touch on the path.
Eigen::AlignedBox2f ProjectOnGround(std::span<const recon::Posture> path_in_world) {
  constexpr float kFlesh_m = 0.2F;  // from a joint to the skin, and clearance; by hand
  Eigen::AlignedBox2f ground;
  for (const recon::Posture& posture : path_in_world) {
    for (const auto& joint_m : posture.position_m) {
      ground.extend(
          Eigen::Vector2f(static_cast<float>(joint_m.x()), static_cast<float>(joint_m.z())));
    }
  }
  if (ground.isEmpty()) return ground;
  const Eigen::Vector2f flesh = Eigen::Vector2f::Constant(kFlesh_m);
  return {ground.min() - flesh, ground.max() + flesh};
}

}  // namespace

std::optional<Occluders> OccludersFromName(std::string_view name) {
  if (name == "none") return Occluders::kNone;
  if (name == "held") return Occluders::kHeld;
  if (name == "scene") return Occluders::kScene;
  if (name == "any") return Occluders::kAny;
  if (name == "held-up") return Occluders::kHeldUp;
  if (name == "desk") return Occluders::kDesk;
  if (name == "wheelchair") return Occluders::kWheelchair;
  if (name == "crutches") return Occluders::kCrutches;
  if (name == "all") return Occluders::kAll;
  return std::nullopt;
}

std::vector<Prop> SampleLastingProps(Occluders kind, std::span<const recon::Posture> path_in_world,
                                     const Eigen::Isometry3d& camera_from_world, Random& random) {
  const Eigen::Vector3d camera_m = camera_from_world.inverse().translation();
  const auto way_m = [&](const recon::Posture& p) {
    return (p[Joint::kHipCenter] - camera_m).norm();
  };
  const auto nearest =
      std::min_element(path_in_world.begin(), path_in_world.end(),
                       [&](const auto& a, const auto& b) { return way_m(a) < way_m(b); });
  double widest_m = 0.0;
  for (const auto& posture : path_in_world) widest_m = std::max(widest_m, Span_m(posture));
  std::vector<Prop> props;
  // With `any`, most frames have no props: a model must not learn to expect them.
  const bool held = kind == Occluders::kHeld || (kind == Occluders::kAny && random.Chance(0.2));
  const bool scene = kind == Occluders::kScene || (kind == Occluders::kAny && random.Chance(0.2));
  if (held) props.push_back(Held(path_in_world[0], widest_m, random));
  if (held && random.Chance(0.25)) props.push_back(HeldInOneHand(path_in_world[0], random));
  if (scene) props.push_back(StandingBefore(*nearest, camera_from_world, random));
  MoveToCamera(camera_from_world, props);
  return props;
}

std::vector<Prop> SampleProps(Occluders kind, const recon::Posture& joints_in_world,
                              const Eigen::Isometry3d& camera_from_world, Random& random) {
  return SampleLastingProps(kind, {&joints_in_world, 1}, camera_from_world, random);
}

Prop Carried(Prop prop, const recon::Posture& then_in_cam, const recon::Posture& now_in_cam) {
  if (prop.grip == Grip::kNone) return prop;
  const Grasp then = ComputeGrasp(prop.grip, then_in_cam);
  const Grasp now = ComputeGrasp(prop.grip, now_in_cam);
  const auto turn = Eigen::Quaternionf::FromTwoVectors(then.along, now.along);
  prop.mesh_in_cam = depth::Moved(std::move(prop.mesh_in_cam),
                                  Eigen::Translation3f(now.place_m) * turn *
                                      Eigen::Translation3f(-then.place_m) * Affine3f::Identity());
  return prop;
}

depth::TriangleMesh SampleFurniture(Random& random) {
  switch (random.Index(4)) {
    case 0: {
      const float seat_m = Draw(random, 0.35, 0.45), deep_m = Draw(random, 0.5, 0.8);
      return depth::MakeSofa(Draw(random, 0.8, 2.2), deep_m, seat_m);
    }
    case 1:
      return depth::MakeTable(
          {Draw(random, 0.5, 1.8), Draw(random, 0.4, 0.9), Draw(random, 0.4, 0.9)});
    case 2: {
      const float back_m = Draw(random, 0.4, 0.6), width_m = Draw(random, 0.4, 0.55);
      return depth::MakeChair(Draw(random, 0.4, 0.5), width_m, back_m);
    }
    default: {  // a cupboard or a shelf
      const float deep_m = Draw(random, 0.3, 0.6), high_m = Draw(random, 0.6, 2.1);
      return depth::Moved(depth::MakeBox({Draw(random, 0.4, 1.4), high_m, deep_m}),
                          Affine3f(Eigen::Translation3f(0, high_m / 2, 0)));
    }
  }
}

namespace {

/// Coordinates of a world point on the floor plan.
Eigen::Vector2f OnGround(const Eigen::Vector3d& place_m) {
  return Eigen::Vector2d(place_m.x(), place_m.z()).cast<float>();
}

/// A room around the origin, where the person stands; the camera looks along -z. Distances in
/// metres from the person to the wall behind it and to the wall behind the camera, width, and
/// sideways offset of the centre.
struct RoomExtent {
  float behind_m, before_m, width_m, shift_m;
};

/// A room that contains the person, all cameras and `path` on the floor plan.
RoomExtent SampleRoomExtent(Random& random, const Eigen::Vector3d& camera_m,
                            const Eigen::AlignedBox2f& path,
                            std::span<const Eigen::Vector3d> cameras_m) {
  constexpr float kPersonClear_m = 0.5F;  // anthropometry: from walls
  constexpr float kCameraClear_m = 0.3F;  // by hand: nearer, a sensor measures nothing
  RoomExtent room{};
  room.behind_m = Draw(random, 0.5, 3.0);
  room.before_m = static_cast<float>(camera_m.z()) + Draw(random, 0.3, 1.0);
  room.width_m = Draw(random, 2.5, 6.0);
  room.shift_m = Draw(random, -0.3, 0.3) * room.width_m;
  Eigen::AlignedBox2f inside = path;
  const auto keep_clear = [&inside](const Eigen::Vector2f& place_m, float clear_m) {
    inside.extend(place_m - Eigen::Vector2f::Constant(clear_m));
    inside.extend(place_m + Eigen::Vector2f::Constant(clear_m));
  };
  keep_clear(Eigen::Vector2f::Zero(), kPersonClear_m);
  keep_clear(OnGround(camera_m), kCameraClear_m);
  for (const Eigen::Vector3d& other_m : cameras_m) keep_clear(OnGround(other_m), kCameraClear_m);
  const float left_m = room.shift_m - room.width_m / 2, right_m = room.shift_m + room.width_m / 2;
  const float low_m = std::min(left_m, inside.min().x());
  const float high_m = std::max(right_m, inside.max().x());
  if (!path.isEmpty() || low_m < left_m || high_m > right_m) {
    room.width_m = high_m - low_m;
    room.shift_m = (low_m + high_m) / 2;
  }
  room.behind_m = std::max(room.behind_m, -inside.min().y());
  room.before_m = std::max(room.before_m, inside.max().y());
  return room;
}

/// Furniture along the wall behind the person and at both sides, not at the person's place.
depth::TriangleMesh SamplePlacedFurniture(Random& random, const RoomExtent& room) {
  const float side = random.Chance(0.5) ? 1.0F : -1.0F;
  const float z_m = -Draw(random, 0.0, room.behind_m);
  const float aside_m = side * Draw(random, 0.7, std::max(0.8, 0.45 * room.width_m));
  const Vector3f place_m(room.shift_m * 0.5F + aside_m, 0.0F, z_m);
  const auto turn = Eigen::AngleAxisf(static_cast<float>(random.Normal(0, 0.3)), Vector3f::UnitY());
  return depth::Moved(SampleFurniture(random),
                      Eigen::Translation3f(place_m) * turn * Affine3f::Identity());
}

}  // namespace

std::vector<Prop> SampleRoom(const Eigen::Isometry3d& camera_from_world, Random& random,
                             std::span<const recon::Posture> path_in_world,
                             std::span<const Eigen::Vector3d> cameras_m) {
  constexpr float kLowCeiling_m = 2.4F,
                  kAir_m = 0.05F;  // ceiling, and clearance above the camera; by hand
  const Eigen::Vector3d camera_m = camera_from_world.inverse().translation();
  Eigen::AlignedBox2f path = ProjectOnGround(path_in_world);
  for (const Eigen::Vector3d& other_m : cameras_m) path.extend(OnGround(other_m));
  const RoomExtent room = SampleRoomExtent(random, camera_m, path, cameras_m);
  float ceiling_m = Draw(random, 2.3, 3.0);
  const auto camera_height_m = static_cast<float>(camera_m.y());
  if (camera_height_m > kLowCeiling_m) ceiling_m = std::max(ceiling_m, camera_height_m + kAir_m);
  const Eigen::Translation3f middle_m(room.shift_m, 0, (room.before_m - room.behind_m) / 2);
  std::vector<Prop> props;
  props.push_back(
      {depth::Moved(depth::MakeRoom({room.width_m, ceiling_m, room.behind_m + room.before_m}),
                    Affine3f(middle_m)),
       false});
  const size_t count = random.Index(4);
  for (size_t i = 0; i < count; ++i) {
    depth::TriangleMesh furniture = SamplePlacedFurniture(random, room);
    if (path.isEmpty() || !path.intersects(ProjectOnGround(furniture)))
      props.push_back({std::move(furniture), false});
  }
  MoveToCamera(camera_from_world, props);
  return props;
}

void MoveToCamera(const Eigen::Isometry3d& to_from_from, std::vector<Prop>& props) {
  const Affine3f move(to_from_from.cast<float>().matrix());
  for (Prop& prop : props) prop.mesh_in_cam = depth::Moved(std::move(prop.mesh_in_cam), move);
}

}  // namespace ossa::tools
