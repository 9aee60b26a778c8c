#include <algorithm>
#include <array>

#include "recon/body/parts.h"
#include "tools/synth/visibility_internal.h"

namespace ossa::tools {
namespace {

/// A joint's own parts (labels of parts.h) and the distance up to which their surface counts.
struct JointSurface {
  std::array<uint8_t, 6> parts;
  double reach_m;
};

constexpr std::array<JointSurface, recon::kJointCount> kSurfaces = {{
    {{20, 21, 0, 0, 0, 0}, 0.20},    // hip centre: lower torso
    {{18, 19, 20, 21, 0, 0}, 0.20},  // spine: torso
    {{5, 6, 7, 18, 19, 0}, 0.15},    // shoulder centre: neck, shoulders, upper torso
    {{1, 2, 3, 4, 0, 0}, 0.18},      // head
    {{6, 8, 0, 0, 0, 0}, 0.13},      // left shoulder ...
    {{12, 0, 0, 0, 0, 0}, 0.11},    {{14, 0, 0, 0, 0, 0}, 0.09}, {{16, 0, 0, 0, 0, 0}, 0.13},
    {{7, 9, 0, 0, 0, 0}, 0.13},  // right shoulder ...
    {{13, 0, 0, 0, 0, 0}, 0.11},    {{15, 0, 0, 0, 0, 0}, 0.09}, {{17, 0, 0, 0, 0, 0}, 0.13},
    {{20, 22, 0, 0, 0, 0}, 0.17},  // left hip ...
    {{26, 0, 0, 0, 0, 0}, 0.13},    {{28, 0, 0, 0, 0, 0}, 0.12}, {{30, 0, 0, 0, 0, 0}, 0.14},
    {{21, 23, 0, 0, 0, 0}, 0.17},  // right hip ...
    {{27, 0, 0, 0, 0, 0}, 0.13},    {{29, 0, 0, 0, 0, 0}, 0.12}, {{31, 0, 0, 0, 0, 0}, 0.14},
}};
// Constants: chosen by hand unless stated otherwise.

constexpr double kLeastArea_m2 = 4e-4;  // 2 × 2 cm: less is a sliver at an edge
constexpr double kLeastPixels = 4;      // pixels

using JointsByPart = std::array<std::vector<size_t>, recon::kLabelCount>;

JointsByPart MakeJointsByPart() {
  JointsByPart joints;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    for (const uint8_t part : kSurfaces[j].parts) {
      if (part != 0) joints[part].push_back(j);
    }
  }
  return joints;
}

}  // namespace

void MarkVisibleJoints(LabelledFrame* frame) {
  static const JointsByPart joints_of_part = MakeJointsByPart();
  const depth::Camera& camera = frame->depth.camera;
  struct Seen {
    recon::JointArray<double> area_m2{}, pixels{};
  };
  std::vector<Seen> seen(frame->bodies.size());
  size_t i = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u, ++i) {
      const size_t body = frame->users.data[i];  // ids are indices into bodies, from 1
      if (body == 0 || body > seen.size() || frame->depth.depth_mm[i] == 0) continue;
      const auto& joints = joints_of_part[frame->parts.data[i]];
      if (joints.empty()) continue;
      const Eigen::Vector3d point_m = depth::BackProject(camera, u, v, frame->depth.depth_mm[i]);
      const double area_m2 = point_m.z() * point_m.z() / (camera.fx * camera.fy);
      for (const size_t j : joints) {
        const auto& joint_m = frame->bodies[body - 1].joints_m.position_m[j];
        if ((point_m - joint_m).squaredNorm() > kSurfaces[j].reach_m * kSurfaces[j].reach_m) {
          continue;
        }
        seen[body - 1].area_m2[j] += area_m2;
        seen[body - 1].pixels[j] += 1;
      }
    }
  }
  for (size_t b = 0; b < seen.size(); ++b) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      frame->bodies[b].visible[j] =
          seen[b].area_m2[j] >= kLeastArea_m2 && seen[b].pixels[j] >= kLeastPixels;
    }
  }
}

}  // namespace ossa::tools
