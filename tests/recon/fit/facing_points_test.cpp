#include "recon/fit/facing_points_internal.h"

#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {
namespace {

class FacingPointsTest : public testing::Test {
 protected:
  FacingPointsTest() {
    posed_.PoseSegments(RandomPose(4));
    posed_.PosePoints();
    facing_.Gather(posed_);
  }

  // Squared distance, including the penalty for other parts.
  double Distance2(const SeenPerson::Pixel& pixel, size_t point, double other_m) const {
    const bool other = pixel.part != 0 && pixel.part != posed_.surface().points[point].part;
    return (posed_.at_m()[point] - pixel.at_m).squaredNorm() + (other ? other_m * other_m : 0.0);
  }

  // How much farther the result is than the true nearest point by definition.
  double TooFar_m2(const SeenPerson::Pixel& pixel, const SurfaceFitOptions& options) const {
    const int found = facing_.Nearest(pixel, options);
    EXPECT_TRUE(posed_.FacesCamera(static_cast<size_t>(found)));
    double least = std::numeric_limits<double>::infinity();
    for (const uint32_t i : facing_.points()) {
      least = std::min(least, Distance2(pixel, i, options.other_part_m));
    }
    return Distance2(pixel, static_cast<size_t>(found), options.other_part_m) - least;
  }

  PosedSurface posed_{Surface()};
  FacingPoints facing_;
};

TEST_F(FacingPointsTest, FindsTheNearestPoint) {
  ASSERT_GT(facing_.points().size(), 100U);
  SurfaceFitOptions options;
  options.adjacent_part_m = options.other_part_m;  // parts that touch are told apart below
  std::mt19937 random(3);
  std::normal_distribution<double> away_m(0.0, 0.1);
  constexpr double kRounding_m2 = 1e-6;  // a micrometre at up to a metre
  for (const uint32_t near : facing_.points()) {
    const Eigen::Vector3d off_m(away_m(random), away_m(random), away_m(random));
    for (const uint8_t part : {uint8_t{0}, posed_.surface().points[near].part, uint8_t{14}}) {
      EXPECT_LT(TooFar_m2({posed_.at_m()[near] + off_m, part, 1.0}, options), kRounding_m2) << near;
    }
  }
}

// A pixel of the left hand at the position of the right one: adjacent parts are preferred over
// nearer ones.
TEST_F(FacingPointsTest, PrefersAdjacentParts) {
  constexpr uint8_t kHand = 16, kWrist = 14, kOther = 17;
  SurfaceFitOptions options;
  options.adjacent_part_m = 0.0;
  options.other_part_m = 100.0;
  int tried = 0;
  for (const uint32_t i : facing_.points()) {
    if (posed_.surface().points[i].part != kOther) continue;
    const int found = facing_.Nearest({posed_.at_m()[i], kHand, 1.0}, options);
    const uint8_t part = posed_.surface().points[static_cast<size_t>(found)].part;
    EXPECT_TRUE(part == kHand || part == kWrist) << int{part};
    ++tried;
  }
  EXPECT_GT(tried, 0);
}

TEST(FacingPoints, NoPointsGiveNoNearest) {
  EXPECT_EQ(FacingPoints().Nearest({Eigen::Vector3d(0, 0, 2), 3, 1.0}, SurfaceFitOptions()), -1);
}

// Points beside the silhouette are assigned its nearest cell, up to one cell.
TEST(SeenPerson, FindsTheNearestSilhouettePoint) {
  const SeenSurface seen(RandomPose(2));
  const SurfaceFitInput input = seen.Input(seen.joints_m);
  SeenPerson person;
  person.Look(input, SurfaceFitOptions());
  const depth::Camera& camera = seen.frame.camera;
  constexpr double kAway_m = 2.0, kCell_px = 3.0;
  int beside = 0;
  for (int v = 10; v < 230; v += 12) {
    for (int u = 90; u < 230; u += 12) {
      const SeenPerson::SightAt at =
          person.At(depth::BackProject(camera, u, v, static_cast<uint16_t>(1000 * kAway_m)));
      if (at.sight != SeenPerson::Sight::kBeside) continue;
      double least_px = std::numeric_limits<double>::infinity();
      for (const int32_t pixel : seen.pixels) {
        least_px = std::min(least_px, std::hypot(pixel % 320 - u, pixel / 320 - v));
      }
      EXPECT_NEAR(at.way_m.norm() * camera.fx / kAway_m, least_px, kCell_px) << u << ", " << v;
      ++beside;
    }
  }
  EXPECT_GT(beside, 40);
}

}  // namespace
}  // namespace ossa::recon
