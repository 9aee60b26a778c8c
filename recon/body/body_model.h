#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "recon/body/rig.h"
#include "recon/posture.h"

namespace ossa::recon {

/// A body shape as MakeHuman's macro parameters. The default is the neutral body.
struct BodyShape {
  double male = 0.5;         // 0 female .. 1 male
  double age = 0.5;          // 0.1875 child, 0.5 young, 1 old; linear between
  double muscle = 0.5;       // 0 .. 1, average at 0.5; so are the next three
  double weight = 0.5;       //
  double height = 0.5;       // stay near 0.5: 0 is 1.38 m tall, 1 is 2.47 m
  double proportions = 0.5;  // 0 uncommon .. 1 ideal
  double african = 1.0 / 3;  // the three sum to 1
  double asian = 1.0 / 3;
  double caucasian = 1.0 / 3;
};

/// A body of one shape in the rig's rest pose: feet on y = 0, facing +z, left = +x, metres.
struct ShapedBody {
  std::vector<Eigen::Vector3f> rest_m;   // BodyModel::vertex_count() entries
  std::vector<Eigen::Vector3f> normals;  // unit, outwards
  std::array<Eigen::Vector3d, kRigBoneCount> bone_head_m;
  JointArray<Eigen::Vector3d> joint_m;  // the SDK's joints at rest
  double height_m = 0.0;                // of the body, without hair and shoes
  double root_scale = 1.0;  // hip height relative to the average body's: scales RigPose::root_m
  /// Axes about which fingers and thumb bend towards the palm: left fingers, left thumb, right ...
  std::array<Eigen::Vector3d, 4> flexion_axis;
};

/// Which layer of the model a vertex or triangle belongs to.
enum class BodyLayer : uint8_t { kSkin, kSkirt, kHair };

/// The MPFB human: a base mesh, shape targets, the rig `cmu_mb` with skinning weights, and a part
/// label on each triangle. Loading takes about 50 ms, the first time about 1 s (a cache is written
/// beside the files when the folder allows it).
class BodyModel {
 public:
  /// Throws InputError naming the file that is missing or damaged.
  static BodyModel Load(const std::filesystem::path& folder);

  ShapedBody Shape(const BodyShape& shape) const;

  size_t vertex_count() const { return base_dm_.size() - kPointCount; }
  const std::vector<std::array<uint32_t, 3>>& triangles() const { return triangles_; }
  /// Part label 1..31 of each triangle.
  const std::vector<uint8_t>& triangle_part() const { return triangle_part_; }
  /// Layer of each vertex. All corners of a triangle have the same layer.
  const std::vector<BodyLayer>& vertex_layer() const { return vertex_layer_; }
  /// Part label of each vertex: that of one of its triangles.
  const std::vector<uint8_t>& vertex_part() const { return vertex_part_; }
  /// Index of the rig bone with the largest skinning weight.
  size_t MainBone(size_t vertex) const { return influence_[vertex].bone[0]; }
  /// The bones that move a vertex, in descending order of weight; weights sum to 1.
  struct Influence {
    std::array<uint8_t, 4> bone{};
    std::array<float, 4> weight{};
  };
  const Influence& InfluenceOn(size_t vertex) const { return influence_[vertex]; }
  /// The neutral position of each vertex, metres; it identifies the vertex's place on the body.
  const std::vector<Eigen::Vector3f>& base_m() const { return base_m_; }

  /// Linear-blend skinning: v' = cam_from_world · sum_b w_b (R_b (v - head_b) + head'_b). `rest_m`
  /// may be the body's rest vertices displaced by clothing.
  void Skin(const ShapedBody& body, std::span<const Eigen::Vector3f> rest_m, const RigPose& pose,
            const Eigen::Isometry3d& cam_from_world, std::span<Eigen::Vector3f> posed_m) const;

 private:
  friend struct BodyModelBuilder;

  // Landmarks follow the vertices: bone heads, bone tails, the SDK's joints, and three knuckles of
  // each finger group of ShapedBody::flexion_axis. Each is a mean of vertices, so the target deltas
  // of a landmark are means, too.
  static constexpr size_t kLandmarkCount = kJointCount + 12;
  static constexpr size_t kPointCount = 2 * kRigBoneCount + kLandmarkCount;

  struct Target {
    std::vector<uint16_t> index;
    std::vector<std::array<int16_t, 3>> delta;         // 1/1000 dm, the files' own precision
    std::vector<std::array<float, 3>> point_delta_dm;  // kPointCount
  };

  /// Base mesh and landmarks deformed by the shape's targets, decimetres.
  std::vector<Eigen::Vector3f> Morph(const BodyShape& shape) const;
  const Target& Find(const std::string& name) const;
  void AddTarget(const std::string& name, double weight, std::vector<Eigen::Vector3f>* v_dm) const;

  std::vector<Eigen::Vector3f> base_dm_;
  std::vector<Eigen::Vector3f> base_m_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  std::vector<uint8_t> triangle_part_;
  std::vector<BodyLayer> vertex_layer_;
  std::vector<uint8_t> vertex_part_;
  std::vector<Influence> influence_;
  std::vector<std::string> target_names_;  // sorted
  std::vector<Target> targets_;
};

/// The folder that tools/fetch_body fills: $OSSA_BODY_DIR, else $XDG_CACHE_HOME/ossa/mpfb2, else
/// ~/.cache/ossa/mpfb2.
std::filesystem::path BodyFolder();
bool BodyIsFetched(const std::filesystem::path& folder);

/// Bone heads of a posed body, by forward kinematics.
std::array<Eigen::Vector3d, kRigBoneCount> PosedBoneHeads(const ShapedBody& body,
                                                          const RigPose& pose);
/// The SDK's 20 joints of a posed body, world, metres.
Posture ComputeJoints(const ShapedBody& body, const RigPose& pose);

/// Bends fingers and thumbs: 0 as at rest (open), 1 a fist.
void CloseHands(const ShapedBody& body, double left, double right, RigPose* pose);

}  // namespace ossa::recon
