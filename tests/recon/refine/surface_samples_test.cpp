#include "recon/refine/surface_samples.h"

#include <gtest/gtest.h>

#include "tests/recon/refine/refinement_scene.h"

namespace ossa::recon {
namespace {

using test::kCentre;
using test::kHeight;
using test::kWall_m;
using test::kWidth;
using test::Scene;

const Eigen::Vector3d kAhead_m(0.0, 0.0, kWall_m);

// Of a joint straight ahead, as far away as the wall.
std::array<SurfaceSample, kSurfaceSamples> SamplesOf(const Scene& scene,
                                                     const Eigen::Vector3d& joint_m = kAhead_m) {
  const SurfaceSampler sampler(scene.frame, scene.is_person, Eigen::Matrix3d::Identity());
  return sampler.Around(joint_m);
}

TEST(SurfaceSample, HasEveryFeature) {
  for (int behind_mm = -300; behind_mm <= 300; ++behind_mm) {
    for (int surface = 0; surface <= kSampleTaps; ++surface) {
      for (int hidden = 0; surface + hidden <= kSampleTaps; ++hidden) {
        const SurfaceSample sample(behind_mm, surface, hidden);
        ASSERT_EQ(sample.behind_mm(), behind_mm);
        ASSERT_EQ(sample.surface() * kSampleTaps, static_cast<float>(surface));
        ASSERT_EQ(sample.hidden() * kSampleTaps, static_cast<float>(hidden));
        ASSERT_EQ(sample.surface() + sample.beside() + sample.hidden(), 1.0F);
      }
    }
  }
  EXPECT_EQ(SurfaceSample().behind_mm(), 0);
  EXPECT_EQ(SurfaceSample().beside(), 1.0F);
}

// Left of the middle of the image somebody's surface, right of it the wall a metre behind: the
// cells in the middle of the grids are half of each.
TEST(SurfaceSampler, CellsAtASilhouetteAreShared) {
  Scene scene;
  scene.frame.camera.cx = (kWidth - 1) / 2.0;
  scene.frame.camera.cy = (kHeight - 1) / 2.0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = kWidth / 2; u < kWidth; ++u) {
      const auto i = static_cast<size_t>(v * kWidth + u);
      scene.is_person[i] = 0;
      scene.frame.depth_mm[i] = static_cast<uint16_t>(1000 * (kWall_m + 1.0));
    }
  }
  const auto samples = SamplesOf(scene);
  EXPECT_EQ(samples[kCentre].surface(), 0.5F);
  EXPECT_EQ(samples[kCentre].beside(), 0.5F);
  EXPECT_NEAR(samples[kCentre].behind_mm(), 0, 1);  // of the surface alone
  float surface = 0.0F, beside = 0.0F;
  for (const SurfaceSample& sample : samples) {
    surface += sample.surface();
    beside += sample.beside();
  }
  EXPECT_EQ(surface, kSurfaceSamples / 2.0F);
  EXPECT_EQ(beside, kSurfaceSamples / 2.0F);
}

// Every other column is 4 cm nearer: of the coarser grid a cell is many pixels wide.
TEST(SurfaceSampler, CellIsTheMeanOfItsQuarters) {
  Scene scene;
  scene.frame.camera.fx = scene.frame.camera.fy =
      2.0 * kWall_m / kSurfaceGridSteps_m[1];  // two pixels
  scene.frame.camera.cx = (kWidth - 1) / 2.0;
  scene.frame.camera.cy = (kHeight - 1) / 2.0;
  for (size_t i = 0; i < scene.frame.depth_mm.size(); i += 2) scene.frame.depth_mm[i] -= 40;
  const auto samples = SamplesOf(scene);
  constexpr size_t kCoarseCentre = kSurfaceSamples / 2 + kCentre;
  EXPECT_NEAR(samples[kCoarseCentre].behind_mm(), -20, 1);
  EXPECT_EQ(samples[kCoarseCentre].surface(), 1.0F);
}

TEST(SurfaceSampler, TooNearOrOutsideIsOccluded) {
  const Scene scene;
  for (const Eigen::Vector3d& joint_m :
       {Eigen::Vector3d(50.0, 0.0, kWall_m), Eigen::Vector3d(0.0, -50.0, kWall_m),
        Eigen::Vector3d(0.0, 0.0, -kWall_m), Eigen::Vector3d(0.0, 0.0, 0.0),
        Eigen::Vector3d(0.0, 0.0, 0.1), Eigen::Vector3d(1e-9, -1e-9, 1e-9)}) {
    for (const SurfaceSample& sample : SamplesOf(scene, joint_m)) ASSERT_EQ(sample.hidden(), 1.0F);
  }
  // What lies far before or behind the joint is as far as a network is conditioned of.
  EXPECT_EQ(SamplesOf(scene, {0.0, 0.0, kWall_m + 1.0})[kCentre].behind_mm(), -300);
  EXPECT_EQ(SamplesOf(scene, {0.0, 0.0, kWall_m - 1.0})[kCentre].behind_mm(), 300);
}

}  // namespace
}  // namespace ossa::recon
