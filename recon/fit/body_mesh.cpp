#include "recon/fit/body_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "recon/motion/humanoid.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kMeshFormat = {
    {'O', 'S', 'S', 'A', 'M', 'S', '0', '0'}, BodyMesh::kVersion, "body mesh"};
constexpr double kStep_m = 1e-4;     // resolution of positions; by hand: finer than skin is known
constexpr double kWeightStep = 255;  // steps of a weight's byte, by definition
constexpr int kLevel = 19;           // zstd level; by hand: the smallest files

/// The numbers of a surface by which its mesh identifies it: joints and landmarks, as stored.
std::vector<float> CollectOutline(const BodySurface& surface) {
  std::vector<float> outline;
  const auto add = [&](const ShapedPlace& place) {
    for (const double value : place.mean_m) outline.push_back(static_cast<float>(value));
    for (Eigen::Index i = 0; i < place.by_shape_m.size(); ++i) {
      outline.push_back(static_cast<float>(place.by_shape_m(i)));
    }
  };
  for (const ShapedPlace& joint : surface.joint) add(joint);
  for (const ShapedPlace& landmark : surface.landmark) add(landmark);
  return outline;
}

template <typename Matrix>
void PutSteps(PayloadWriter& out, const Matrix& values_m) {
  for (Eigen::Index i = 0; i < values_m.size(); ++i) {
    out.Put(static_cast<int16_t>(std::lround(values_m(i) / kStep_m)));
  }
}

template <typename Matrix>
void GetSteps(PayloadReader& in, const char* field, Matrix& values_m) {
  for (Eigen::Index i = 0; i < values_m.size(); ++i) {
    values_m(i) = kStep_m * in.Get<int16_t>(field);
  }
}

MeshVertex GetVertex(PayloadReader& in) {
  MeshVertex vertex;
  float sum = 0.0F;
  for (size_t k = 0; k < vertex.bone.size(); ++k) {
    vertex.bone[k] = in.Get<uint8_t>("bone of a vertex");
    if (vertex.bone[k] >= kHumanBoneCount) {
      in.Fail("bone of a vertex", fmt::format("expected 0 to {}", kHumanBoneCount - 1));
    }
    vertex.weight[k] = in.Get<uint8_t>("weight of a vertex");
    sum += vertex.weight[k];
  }
  if (sum == 0.0F) in.Fail("weight of a vertex", "expected a bone that carries it, found none");
  for (float& weight : vertex.weight) weight /= sum;
  GetSteps(in, "place of a vertex", vertex.place.mean_m);
  GetSteps(in, "place of a vertex", vertex.place.by_shape_m);
  return vertex;
}

BodyMesh FromPayload(std::span<const std::byte> payload, const std::string& name,
                     const BodySurface& surface) {
  PayloadReader in(payload, name);
  BodyMesh mesh;
  mesh.surface = surface;
  if (in.GetVector<float>("surface") != CollectOutline(surface)) {
    throw InputError(name + ": expected the mesh of the body surface in use, found another one's");
  }
  const auto vertices = in.Get<uint32_t>("vertices");
  if (vertices < 3 || vertices > BodyMesh::kMostVertices) {
    in.Fail("vertices", fmt::format("expected 3 to {}", BodyMesh::kMostVertices));
  }
  for (uint32_t i = 0; i < vertices; ++i) mesh.vertices.push_back(GetVertex(in));
  const auto corners = in.GetVector<uint16_t>("triangles");
  if (corners.empty() || corners.size() % 3 != 0) {
    in.Fail("triangles", "expected three corners each");
  }
  for (size_t i = 0; i < corners.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) {
      if (corners[i + k] >= vertices) {
        in.Fail("triangles", fmt::format("expected corners 0 to {}", vertices - 1));
      }
    }
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  in.ExpectEnd();
  return mesh;
}

}  // namespace

void BodyMesh::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.PutVector(CollectOutline(surface));
  out.Put(static_cast<uint32_t>(vertices.size()));
  for (const MeshVertex& vertex : vertices) {
    for (size_t k = 0; k < vertex.bone.size(); ++k) {
      out.Put(vertex.bone[k]);
      out.Put(static_cast<uint8_t>(std::lround(vertex.weight[k] * kWeightStep)));
    }
    PutSteps(out, vertex.place.mean_m);
    PutSteps(out, vertex.place.by_shape_m);
  }
  std::vector<uint16_t> corners;
  for (const MeshTriangle& triangle : triangles) {
    for (const uint32_t corner : triangle) corners.push_back(static_cast<uint16_t>(corner));
  }
  out.PutVector(corners);
  WriteContainer(path, kMeshFormat, Compress(out.bytes(), kLevel));
}

BodyMesh BodyMesh::Load(const std::filesystem::path& path, const BodySurface& surface) {
  return NamingTheFile(path, [&] {
    const auto payload =
        Decompress(ReadContainer(path, kMeshFormat), path.string(), kMeshFormat.what);
    return FromPayload(payload, path.string(), surface);
  });
}

bool BodyMesh::IsFile(const std::filesystem::path& path) { return IsContainer(path, kMeshFormat); }

size_t SegmentOfHumanBone(size_t bone) {
  using enum Segment;
  static constexpr std::array<Segment, kHumanBoneCount> kSegments = {
      kPelvis,       kAbdomen,     kChest,     kHead,        kHead,          kLeftCollar,
      kLeftUpperArm, kLeftForearm, kLeftHand,  kRightCollar, kRightUpperArm, kRightForearm,
      kRightHand,    kLeftThigh,   kLeftShank, kLeftFoot,    kLeftFoot,      kRightThigh,
      kRightShank,   kRightFoot,   kRightFoot};
  return static_cast<size_t>(kSegments[bone]);
}

std::vector<Eigen::Vector3d> PoseMesh(const BodyMesh& mesh, const SurfacePose& pose) {
  PosedSurface posed(mesh.surface);
  posed.PoseSegments(pose);
  std::array<Eigen::Vector3d, kSegmentCount> rest_m;  // joint of each segment
  rest_m[0].setZero();
  for (size_t s = 1; s < kSegmentCount; ++s) {
    rest_m[s] = rest_m[ParentSegment(s)] + mesh.surface.joint[s].At(pose.shape);
  }
  std::vector<Eigen::Vector3d> places_m;
  places_m.reserve(mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.vertices) {
    const Eigen::Vector3d at_m = vertex.place.At(pose.shape);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t k = 0; k < vertex.bone.size(); ++k) {
      if (vertex.weight[k] == 0.0F) continue;
      const size_t s = SegmentOfHumanBone(vertex.bone[k]);
      sum += static_cast<double>(vertex.weight[k]) *
             (posed.joint_m(s) + posed.camera_from(s) * (at_m - rest_m[s]));
    }
    places_m.push_back(sum);
  }
  return places_m;
}

}  // namespace ossa::recon
