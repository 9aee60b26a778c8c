#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "depth/base/random.h"
#include "depth/render/renderer.h"
#include "recon/body/parts.h"
#include "recon/posture.h"

namespace ossa::tools {

/// The values of `ossa render --occluders`.
enum class Occluders { kNone, kHeld, kScene, kAny, kHeldUp, kDesk, kWheelchair, kCrutches, kAll };
std::optional<Occluders> OccludersFromName(std::string_view name);

/// The hands that hold an object.
enum class Grip { kNone, kLeftHand, kRightHand, kBothHands };

/// An object in the image that is not a person.
struct Prop {
  depth::TriangleMesh mesh_in_cam;
  /// True: held or worn by the person, or close in front of it: a segmenter counts its pixels as
  /// the person's. False: background, label 0.
  bool counts_as_other = true;
  Grip grip = Grip::kNone;
  uint8_t part = recon::kOtherPart;  // label if it counts; a hat has the head's
  uint8_t user = 1;                  // id of its person
};

/// Draws held objects (boxes, balls, sticks, boards, bags) and occluders between person and camera
/// (tables, chairs, boards, boxes), after Shum 2013 figs. 3-4. World: metres, y up, floor at y = 0.
/// Meshes are in camera space.
std::vector<Prop> SampleProps(Occluders kind, const recon::Posture& joints_in_world,
                              const Eigen::Isometry3d& camera_from_world, Random& random);

/// The same for a sequence in which the person takes the postures of `path_in_world` (at least one)
/// in order; the props fit the first one. Occluders are nearer to the camera than the person ever
/// comes; both hands hold an object only if their distance hardly changes.
std::vector<Prop> SampleLastingProps(Occluders kind, std::span<const recon::Posture> path_in_world,
                                     const Eigen::Isometry3d& camera_from_world, Random& random);

/// Moves a held prop rigidly with its hands: it rotates with the forearm or with the line between
/// the hands. Other props stay in place. Joints in camera space, metres.
Prop Carried(Prop prop, const recon::Posture& then_in_cam, const recon::Posture& now_in_cam);

/// A random sofa, table, chair or cupboard that stands on y = 0 and faces +z, metres.
depth::TriangleMesh SampleFurniture(Random& random);

/// A furnished room around the person and the camera: floor, walls at random distances, furniture
/// along them; all of it is background. The room contains `path_in_world` and the other cameras at
/// `cameras_m` (world, metres); furniture that would stand in their way is left out.
std::vector<Prop> SampleRoom(const Eigen::Isometry3d& camera_from_world, Random& random,
                             std::span<const recon::Posture> path_in_world = {},
                             std::span<const Eigen::Vector3d> cameras_m = {});

/// Transforms the meshes of the props to another camera's space.
void MoveToCamera(const Eigen::Isometry3d& to_from_from, std::vector<Prop>& props);

}  // namespace ossa::tools
