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

/// What a thing goes along with.
enum class Grip { kNone, kLeftHand, kRightHand, kBothHands };

/// A thing in the picture that is not a person.
struct Prop {
  depth::TriangleMesh mesh_in_cam;
  /// True: held by, worn by or standing close before the person, and one of the person's pixels to
  /// a segmenter. False: background, label 0.
  bool counts_as_other = true;
  Grip grip = Grip::kNone;
  uint8_t part = recon::kOtherPart;  // its label, when it counts: of a hat the head's
  uint8_t user = 1;                  // whose it is
};

/// Things to hold (boxes, balls, sticks, boards, bags) and things that stand before a person
/// (tables, chairs, boards, boxes), after Shum 2013 figs. 3-4. World: y up, floor at y = 0;
/// joints in world; the camera's place decides what is before the person.
std::vector<Prop> SampleProps(Occluders kind, const recon::Posture& joints_in_world,
                              const Eigen::Isometry3d& camera_from_world, Random& random);

/// The same for a scene that goes on: the person takes the postures of `path_in_world` one after
/// the other (one at least), the props are those of the first. What stands is nearer to the camera
/// than the person ever comes; both hands hold a thing only when they never part.
std::vector<Prop> SampleLastingProps(Occluders kind, std::span<const recon::Posture> path_in_world,
                                     const Eigen::Isometry3d& camera_from_world, Random& random);

/// The prop after the hands that hold it have moved: as stiff as it was, turned with the forearm or
/// with the line between the hands. What nobody holds stays. Joints in camera space, metres.
Prop Carried(Prop prop, const recon::Posture& then_in_cam, const recon::Posture& now_in_cam);

/// A sofa, table, chair or cupboard that stands on y = 0 and faces +z.
depth::TriangleMesh SampleFurniture(Random& random);

/// A furnished room around the person and the camera: floor, walls at random distances, things
/// along them. All background. The person's whole path has room in it, when one is given: walls
/// give way, and what would stand on it is left out; so it is with other cameras that look at it
/// from `cameras_m` (world).
std::vector<Prop> SampleRoom(const Eigen::Isometry3d& camera_from_world, Random& random,
                             std::span<const recon::Posture> path_in_world = {},
                             std::span<const Eigen::Vector3d> cameras_m = {});

/// Things in one camera's space as another sees them.
void MoveToCamera(const Eigen::Isometry3d& to_from_from, std::vector<Prop>& props);

}  // namespace ossa::tools
