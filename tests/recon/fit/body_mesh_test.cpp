#include "recon/fit/body_mesh.h"

#include <algorithm>
#include <filesystem>

#include "depth/base/error.h"
#include "recon/bone_lengths.h"
#include "recon/fit/skinned_body.h"
#include "tests/recon/fit/posed_person.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

std::filesystem::path ShippedPath() {
  return test::SourceFolder() / "tools/tracker/shipped" / kShippedMesh;
}

const BodyMesh& Shipped() {
  static const BodyMesh mesh = BodyMesh::Load(ShippedPath(), Surface());
  return mesh;
}

TEST(BodyMesh, ShippedMeshIsSmallAndFitsTheShippedSurface) {
  EXPECT_LT(std::filesystem::file_size(ShippedPath()), 300'000U);
  EXPECT_TRUE(BodyMesh::IsFile(ShippedPath()));
  EXPECT_GT(Shipped().vertices.size(), 1500U);
  EXPECT_GT(Shipped().triangles.size(), 3000U);
}

TEST(BodyMesh, IsReadAsWritten) {
  const test::TemporaryFolder folder;
  Shipped().Save(folder / "x.ossamesh");
  const BodyMesh read = BodyMesh::Load(folder / "x.ossamesh", Surface());
  EXPECT_EQ(read.triangles, Shipped().triangles);
  for (size_t i = 0; i < read.vertices.size(); ++i) {
    EXPECT_EQ(read.vertices[i].place.by_shape_m, Shipped().vertices[i].place.by_shape_m);
    EXPECT_EQ(read.vertices[i].bone, Shipped().vertices[i].bone);
  }
}

TEST(BodyMesh, MeshOfAnotherSurfaceIsRefused) {
  BodySurface other = Surface();
  other.joint[3].mean_m.x() += 0.01;
  test::ExpectRefused([&] { BodyMesh::Load(ShippedPath(), other); },
                      "expected the mesh of the body surface in use");
}

// Wherever its payload is cut, the file is named.
TEST(BodyMesh, TruncationIsRefused) {
  const test::TemporaryFolder folder;
  std::filesystem::copy_file(ShippedPath(), folder / "cut.ossamesh");
  for (const uintmax_t kept : {10U, 1000U, 50000U}) {
    std::filesystem::resize_file(
        folder / "cut.ossamesh",
        std::min<uintmax_t>(kept, std::filesystem::file_size(folder / "cut.ossamesh")));
    test::ExpectRefused([&] { BodyMesh::Load(folder / "cut.ossamesh", Surface()); },
                        "cut.ossamesh");
  }
}

// The skin lies where the surface's own points do: both were learned of the same people.
TEST(BodyMesh, LiesOnTheSurfaceInAnyPoseAndShape) {
  SurfacePose pose;
  pose.shape[0] = 1.5;
  pose.pelvis_m = {0.2, 0.1, 2.0};
  pose.parent_from_segment[size_t(Segment::kLeftForearm)] = ToRotation(Vector3d(0.0, -1.2, 0.0));
  PosedSurface posed(Surface());
  posed.PoseSegments(pose);
  posed.PosePoints();
  const std::vector<Vector3d> skin = PoseMesh(Shipped(), pose);
  std::vector<double> away_m;
  for (const Vector3d& point : posed.at_m()) {
    double nearest = 1.0;
    for (const Vector3d& vertex : skin) nearest = std::min(nearest, (vertex - point).norm());
    away_m.push_back(nearest);
  }
  std::sort(away_m.begin(), away_m.end());
  EXPECT_LT(away_m[away_m.size() / 2], 0.03);  // vertices are 3 to 5 cm apart
  EXPECT_LT(away_m[away_m.size() * 95 / 100], 0.06);
}

TEST(SkinnedBody, RestsInATPoseWithThePersonsBones) {
  BoneLengths lengths_m = MeasureBoneLengths(PosedSurface(Surface()).Landmarks());
  for (double& length : lengths_m) length *= 0.8;  // a child
  lengths_m[Index(Joint::kElbowLeft)] *= 1.1;
  const SkinnedBody body = BuildTPosedBody(Shipped(), ShapeVector::Zero(), lengths_m);
  const BoneLengths made_m = MeasureBoneLengths(body.joints_m);
  for (size_t j = 1; j < kJointCount; ++j) EXPECT_NEAR(made_m[j], lengths_m[j], 1e-9);
  const auto along = [&](Joint from, Joint to) {
    return (body.joints_m[to] - body.joints_m[from]).normalized().eval();
  };
  EXPECT_GT(along(Joint::kShoulderLeft, Joint::kWristLeft).x(), 0.999);
  EXPECT_LT(along(Joint::kShoulderRight, Joint::kWristRight).x(), -0.999);
  EXPECT_LT(along(Joint::kHipLeft, Joint::kAnkleLeft).y(), -0.999);
  EXPECT_GT(along(Joint::kAnkleLeft, Joint::kFootLeft).z(), 0.8);
}

TEST(SkinnedBody, SkinSurroundsItsJointsAndStandsOnTheGround) {
  const BoneLengths lengths_m = MeasureBoneLengths(PosedSurface(Surface()).Landmarks());
  const SkinnedBody body = BuildTPosedBody(Shipped(), ShapeVector::Zero(), lengths_m);
  double lowest = 1.0, highest = 0.0;
  for (size_t i = 0; i < body.vertices_m.size(); ++i) {
    lowest = std::min(lowest, body.vertices_m[i].y());
    highest = std::max(highest, body.vertices_m[i].y());
    EXPECT_NEAR(body.normals[i].norm(), 1.0, 1e-9);
  }
  EXPECT_NEAR(lowest, 0.0, 1e-9);
  EXPECT_NEAR(highest, Surface().stature_mean_m, 0.05);
  for (const Joint joint : {Joint::kElbowLeft, Joint::kKneeRight, Joint::kWristLeft}) {
    double nearest = 1.0;
    for (const Vector3d& v : body.vertices_m) {
      nearest = std::min(nearest, (v - body.joints_m[joint]).norm());
    }
    EXPECT_LT(nearest, 0.09);
  }
}

}  // namespace
}  // namespace ossa::recon
