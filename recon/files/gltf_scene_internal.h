#pragma once
#include <cstddef>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "recon/fit/body_mesh.h"
#include "recon/fit/skinned_body.h"
#include "recon/motion/humanoid.h"

namespace ossa::recon {

/// Number of a person's nodes: bones in the order of kHumanBones, then the ends of the hands.
inline constexpr size_t kPersonNodes = kHumanBoneCount + 2;

/// A node in the rest pose, with its parent's orientation: index of the parent (-1: the person's
/// root) and position.
struct RestNode {
  std::string name;
  int parent = -1;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
};

/// A person's motion: keyframes in order of time, starting at 0 s.
struct PersonTracks {
  std::vector<float> time_s;
  /// Relative to the parent, per keyframe x y z and x y z w; empty: the rest pose.
  std::vector<std::vector<float>> translation_m, rotation;
  /// Visibility as a step function: times, and 1 or 0 at each; empty: always visible.
  std::vector<float> presence_s, presence;
};

/// A scene of skinned people in motion, glTF 2.0.
class GltfScene {
 public:
  GltfScene();
  ~GltfScene();

  /// `body` and `mesh` null: a skeleton without skin.
  void AddPerson(const std::string& name, std::span<const RestNode> nodes, const SkinnedBody* body,
                 const BodyMesh* mesh, const PersonTracks& tracks);
  /// Size of the buffers so far.
  size_t Bytes() const;
  /// As binary glTF (.glb).
  void Write(std::ostream& stream);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::recon
