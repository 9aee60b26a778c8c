// Properties that tests/python/test_gltf.py does not check with other readers.
#include <gtest/gtest.h>
#include <malloc.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "depth/base/atomic_file.h"
#include "recon/files/skeleton_writer.h"
#include "recon/fit/body_mesh.h"
#include "recon/fit/body_surface.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/support/full_disk.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// The skin that ossa ships; null where there is none.
std::shared_ptr<const BodyMesh> ShippedBody() {
  const std::filesystem::path shipped = test::SourceFolder() / "tools/tracker/shipped";
  if (!std::filesystem::exists(shipped / "body.ossamesh")) return nullptr;
  const auto surface = BodySurface::Load(shipped / "body.ossasurface");
  return std::make_shared<BodyMesh>(BodyMesh::Load(shipped / "body.ossamesh", surface));
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(GltfWriter, WithoutAMeshWritesBonesOnly) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "x.glb", ExampleSequence(5), {});
  const std::string text = TextOf(folder / "x.glb");
  EXPECT_EQ(text.substr(0, 4), "glTF");
  EXPECT_NE(text.find("leftUpperArm"), std::string::npos);
  EXPECT_EQ(text.find("\"skin\""), std::string::npos);
}

TEST(GltfWriter, BonesHaveTheRequestedNames) {
  const test::TemporaryFolder folder;
  SkeletonWriteOptions options;
  options.names = BvhNames::kMixamo;
  WriteSkeletons(folder / "x.glb", ExampleSequence(5), options);
  EXPECT_NE(TextOf(folder / "x.glb").find("mixamorig:LeftForeArm"), std::string::npos);
}

TEST(GltfWriter, WritesTheSameBytesEveryTime) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "a.glb", ExampleSequence(5, 2), {});
  WriteSkeletons(folder / "b.glb", ExampleSequence(5, 2), {});
  EXPECT_EQ(TextOf(folder / "a.glb"), TextOf(folder / "b.glb"));
}

// People without a fit must not get an uninitialised shape.
TEST(GltfWriter, UnknownShapeGivesTheMeanBody) {
  const auto body = ShippedBody();
  if (!body) GTEST_SKIP() << "no shipped body";
  SkeletonWriteOptions options;
  options.body = body;
  const test::TemporaryFolder folder;
  constexpr int kAnyByte = 165;
  mallopt(M_PERTURB, kAnyByte);  // new memory is not 0, as at the start of a program
  WriteSkeletons(folder / "unknown.glb", ExampleSequence(5, 2), options);
  SkeletonWriter mean(folder / "mean.glb", options);
  const SkeletonSequence sequence = ExampleSequence(5, 2);
  for (const BodyRecord& body : sequence.frames[0].bodies) {
    mean.SetShape(body.id, ShapeVector::Zero());
  }
  for (const SkeletonFrame& frame : sequence.frames) mean.Write(frame);
  mean.Finish();
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(TextOf(folder / "unknown.glb") == TextOf(folder / "mean.glb"));
}

// Point formats represent an unseen person as a body without joints.
TEST(GltfWriter, BodiesWithoutJointsAreOmitted) {
  const test::TemporaryFolder folder;
  SkeletonSequence lost = ExampleSequence(5);
  WriteSkeletons(folder / "always.glb", lost, {});
  for (auto& joint : lost.frames[2].bodies[0].joints) joint.reset();
  WriteSkeletons(folder / "lost.glb", lost, {});
  EXPECT_EQ(TextOf(folder / "always.glb").find("\"scale\""), std::string::npos);
  EXPECT_NE(TextOf(folder / "lost.glb").find("\"scale\""), std::string::npos);
}

TEST(GltfWriter, RecordingWithoutBodiesIsRefused) {
  const test::TemporaryFolder folder;
  SkeletonSequence nobody = ExampleSequence(3);
  for (SkeletonFrame& frame : nobody.frames) frame.bodies.clear();
  test::ExpectRefused([&] { WriteSkeletons(folder / "x.glb", nobody, {}); },
                      "expected a person in one frame or more, found none");
  EXPECT_FALSE(std::filesystem::exists(folder / "x.glb"));
}

TEST(GltfWriter, LeavesNoFileOnAFullDisk) {
  const test::TemporaryFolder folder;
  {
    const test::FullDisk disk(5000);
    SkeletonWriter writer(folder / "x.glb");
    for (const SkeletonFrame& frame : ExampleSequence(40).frames) writer.Write(frame);
    EXPECT_THROW(writer.Finish(), DiskFull);
    EXPECT_EQ(writer.FinishWithWhatFits(), 0);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// A skin is some 200 kB.
TEST(GltfWriter, KeepsTheMotionIfTheSkinDoesNotFit) {
  const auto body = ShippedBody();
  if (!body) GTEST_SKIP() << "no shipped body";
  SkeletonWriteOptions options;
  options.body = body;
  const test::TemporaryFolder folder;
  SkeletonWriter writer(folder / "x.glb", options);
  for (const SkeletonFrame& frame : ExampleSequence(20).frames) writer.Write(frame);
  const test::FullDisk disk(60000);
  EXPECT_THROW(writer.Finish(), DiskFull);
  EXPECT_GT(writer.FinishWithWhatFits(), 10);
  EXPECT_EQ(TextOf(folder / "x.glb").find("\"skin\""), std::string::npos);
}

}  // namespace
}  // namespace ossa::recon
