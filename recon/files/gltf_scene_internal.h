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

/// Nodes of a person, by their numbers: bones in order of kHumanBones, then the hands' ends.
inline constexpr size_t kPersonNodes = kHumanBoneCount + 2;

/// A node of a person at rest, which is turned as its parent is: number of its parent's (-1: the
/// person's), and where it is.
struct RestNode {
  std::string name;
  int parent = -1;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
};

/// A person's motion: keys in order of time, from 0 s on.
struct PersonTracks {
  std::vector<float> time_s;
  /// Against the parent's, x y z and x y z w of each key; empty: as at rest.
  std::vector<std::vector<float>> translation_m, rotation;
  /// When the person is there, in steps: times, and 1 or 0 at each; empty: always.
  std::vector<float> presence_s, presence;
};

/// A scene of skinned people in motion, glTF 2.0.
class GltfScene {
 public:
  GltfScene();
  ~GltfScene();

  /// `body` and `mesh` null: bones alone.
  void AddPerson(const std::string& name, std::span<const RestNode> nodes, const SkinnedBody* body,
                 const BodyMesh* mesh, const PersonTracks& tracks);
  /// Of the numbers in it until now.
  size_t Bytes() const;
  /// As binary glTF (.glb).
  void Write(std::ostream& stream);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::recon
