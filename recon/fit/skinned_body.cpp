#include "recon/fit/skinned_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "recon/bone_lengths.h"
#include "recon/motion/humanoid.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Direction of a limb's segment in a T-pose; none for trunk, head and feet.
std::optional<Vector3d> LimbDirection(Segment segment) {
  using enum Segment;
  switch (segment) {
    case kLeftUpperArm:
    case kLeftForearm:
    case kLeftHand:
      return Vector3d::UnitX();
    case kRightUpperArm:
    case kRightForearm:
    case kRightHand:
      return -Vector3d::UnitX();
    case kLeftThigh:
    case kLeftShank:
    case kRightThigh:
    case kRightShank:
      return -Vector3d::UnitY();
    default:
      return std::nullopt;
  }
}

/// The landmark at the end of a limb segment's bone: both have the same order, except that leg
/// segments start at the hips.
size_t EndOf(Segment segment) {
  const auto s = static_cast<size_t>(segment);
  if (segment >= Segment::kRightThigh) return s + 2;
  return segment >= Segment::kLeftThigh ? s + 1 : s;
}

/// Each limb segment rotated from the rest pose by the smallest rotation; trunk and feet unchanged.
SurfacePose ComputeTPose(const BodySurface& surface, const ShapeVector& shape) {
  PosedSurface rest(surface);
  SurfacePose pose;
  pose.shape = shape;
  rest.PoseSegments(pose);
  std::array<Matrix3d, kSegmentCount> turned;
  turned.fill(Matrix3d::Identity());
  for (size_t s = 0; s < kSegmentCount; ++s) {
    const auto segment = static_cast<Segment>(s);
    const auto direction = LimbDirection(segment);
    if (!direction) continue;
    const Vector3d along = rest.LandmarkAt(EndOf(segment)) - rest.joint_m(s);
    turned[s] = SmallestTurn(along, *direction).toRotationMatrix();
  }
  for (size_t s = 1; s < kSegmentCount; ++s) {
    pose.parent_from_segment[s] = turned[ParentSegment(s)].transpose() * turned[s];
  }
  return pose;
}

/// Scale of the region around a bone: `girth` across it, `stretch` along it.
Matrix3d Growth(const Vector3d& along, double stretch, double girth) {
  return girth * Matrix3d::Identity() + (stretch - girth) * along * along.transpose();
}

/// Deforms the mesh's own T-pose to a person's bone lengths.
class Fitting {
 public:
  Fitting(const Posture& from, const BoneLengths& lengths_m) : from_(from) {
    // Factors, by hand: limits the damage of a wrongly measured length.
    constexpr double kLeast = 0.5, kMost = 2.0;
    const BoneLengths own_m = MeasureBoneLengths(from);
    double wanted_m = 0.0, sum_m = 0.0;
    for (size_t j = 1; j < kJointCount; ++j) {
      wanted_m += lengths_m[j];
      sum_m += own_m[j];
    }
    girth_ = std::clamp(wanted_m / sum_m, kLeast, kMost);
    to_.position_m[0] = girth_ * from.position_m[0];
    for (size_t j = 1; j < kJointCount; ++j) {
      const size_t p = ParentOf(j);
      along_[j] = (from.position_m[j] - from.position_m[p]).normalized();
      stretch_[j] = std::clamp(lengths_m[j] / own_m[j], kLeast, kMost);
      to_.position_m[j] = to_.position_m[p] + lengths_m[j] * along_[j];
    }
  }

  const Posture& joints_m() const { return to_; }
  Vector3d Moved(const MeshVertex& vertex, const Vector3d& at_m) const {
    Vector3d sum = Vector3d::Zero();
    for (size_t k = 0; k < vertex.bone.size(); ++k) {
      const HumanBoneInfo& bone = kHumanBones[vertex.bone[k]];
      const size_t turner = Index(bone.turner);
      const Matrix3d growth = bone.place == bone.turner
                                  ? Matrix3d(girth_ * Matrix3d::Identity())
                                  : Growth(along_[turner], stretch_[turner], girth_);
      sum += static_cast<double>(vertex.weight[k]) *
             (to_[bone.place] + growth * (at_m - from_[bone.place]));
    }
    return sum;
  }

 private:
  Posture from_, to_;
  JointArray<Vector3d> along_;
  JointArray<double> stretch_{};
  double girth_ = 1.0;
};

std::vector<Vector3d> ComputeNormals(const BodyMesh& mesh, const std::vector<Vector3d>& at_m) {
  std::vector<Vector3d> normals(at_m.size(), Vector3d::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d normal = (at_m[b] - at_m[a]).cross(at_m[c] - at_m[a]);  // weighted by area
    for (const uint32_t corner : {a, b, c}) normals[corner] += normal;
  }
  for (Vector3d& normal : normals) {
    normal = normal.norm() > 0.0 ? Vector3d(normal.normalized()) : Vector3d::UnitY();
  }
  return normals;
}

}  // namespace

SkinnedBody BuildTPosedBody(const BodyMesh& mesh, const ShapeVector& shape,
                            const BoneLengths& lengths_m) {
  const SurfacePose pose = ComputeTPose(mesh.surface, shape);
  PosedSurface posed(mesh.surface);
  posed.PoseSegments(pose);
  const Fitting fitting(posed.Landmarks(), lengths_m);
  SkinnedBody body;
  body.joints_m = fitting.joints_m();
  body.vertices_m = PoseMesh(mesh, pose);
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    body.vertices_m[i] = fitting.Moved(mesh.vertices[i], body.vertices_m[i]);
  }
  const auto lowest =
      std::min_element(body.vertices_m.begin(), body.vertices_m.end(),
                       [](const Vector3d& a, const Vector3d& b) { return a.y() < b.y(); });
  const Vector3d up_m = -lowest->y() * Vector3d::UnitY();
  for (Vector3d& vertex : body.vertices_m) vertex += up_m;
  for (Vector3d& joint : body.joints_m.position_m) joint += up_m;
  body.normals = ComputeNormals(mesh, body.vertices_m);
  return body;
}

}  // namespace ossa::recon
