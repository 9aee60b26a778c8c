#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "depth/render/renderer.h"
#include "recon/posture.h"
#include "tools/synth/random.h"

namespace ossa::tools {

/// `--occluders` of DESIGN.md §4.
enum class Occluders { kNone, kHeld, kScene, kAny };
std::optional<Occluders> OccludersFromName(std::string_view name);

/// A thing in the picture that is not a person.
struct Prop {
  depth::TriangleMesh mesh_in_cam;
  /// True: held by or standing close before the person, part label 32 `other`, and one of the
  /// person's pixels to a segmenter. False: background, label 0.
  bool counts_as_other = true;
};

/// Things to hold (boxes, balls, sticks, boards, bags) and things that stand before a person
/// (tables, chairs, boards, boxes), after Shum 2013 figs. 3-4. World: y up, floor at y = 0;
/// joints in world; the camera's place decides what is before the person.
std::vector<Prop> SampleProps(Occluders kind, const recon::Posture& joints_in_world,
                              const Eigen::Isometry3d& camera_from_world, Random& random);

/// A sofa, table, chair or cupboard that stands on y = 0 and faces +z.
depth::TriangleMesh SampleFurniture(Random& random);

/// A furnished room around the person and the camera: floor, walls at random distances, things
/// along them. All background.
std::vector<Prop> SampleRoom(const Eigen::Isometry3d& camera_from_world, Random& random);

}  // namespace ossa::tools
