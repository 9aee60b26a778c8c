#include "recon/refine/person_crop.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ossa::recon {
namespace {

constexpr double kBoard_m = 2.5;  // from the camera along its axis

// A board of 60 by 80 cm across the optical axis is the person; beside it the wall, 2 m behind.
struct Scene {
  depth::DepthFrame frame;
  std::vector<uint8_t> is_person;

  explicit Scene(int width, int height) {
    frame.camera = depth::KinectV1Camera(width, height);
    frame.depth_mm.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
    is_person.resize(frame.depth_mm.size());
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const Eigen::Vector3d at_m = depth::BackProject(frame.camera, u, v, 1e3 * kBoard_m);
        const bool board = std::abs(at_m.x()) < 0.3 && std::abs(at_m.y()) < 0.4;
        const auto i = static_cast<size_t>(v * width + u);
        frame.depth_mm[i] = static_cast<uint16_t>(1e3 * (board ? kBoard_m : kBoard_m + 2.0));
        is_person[i] = board ? 1 : 0;
      }
    }
  }
};

const PersonCrop::Cell& At(const PersonCrop& crop, double x_m, double y_m) {
  const auto index = [](double m) {
    return static_cast<int>(std::lround((kCropSide - 1) / 2.0 - m / kCropCell_m));
  };
  return crop.cells[static_cast<size_t>(index(y_m) * kCropSide + index(x_m))];
}

TEST(PersonCrop, CellSizeIsIndependentOfTheImageSize) {
  for (const int width : {160, 320, 640}) {
    const Scene scene(width, width * 3 / 4);
    const auto crop = PersonCrop::Cut(scene.frame, scene.is_person);
    ASSERT_TRUE(crop);
    EXPECT_LT((crop->middle_m - Eigen::Vector3d(0, 0, kBoard_m)).norm(), 0.02) << width;
    int whole = 0;
    for (const PersonCrop::Cell& cell : crop->cells) whole += cell.surface;
    EXPECT_NEAR(whole * kCropCell_m * kCropCell_m / kCropTaps, 0.6 * 0.8, 0.03) << width;
    EXPECT_EQ(At(*crop, 0.2, 0.3).surface, kCropTaps) << width;
    EXPECT_NEAR(At(*crop, 0.2, 0.3).behind_mm, 0, 12) << width;
    EXPECT_EQ(At(*crop, 0.4, 0.0).surface, 0) << width;
    EXPECT_EQ(At(*crop, 0.4, 0.0).hidden, 0) << width << ": the wall is beside";
  }
}

TEST(PersonCrop, EncodesBackgroundOccludersAndTheImageBorder) {
  Scene scene(320, 240);
  for (size_t i = 0; i < scene.is_person.size(); ++i) {
    const auto u = static_cast<int>(i) % 320, v = static_cast<int>(i) / 320;
    if (scene.is_person[i] != 0 && v < 100) scene.frame.depth_mm[i] = 2650;
    if (u > 200 && scene.is_person[i] == 0) scene.frame.depth_mm[i] = 1500;  // at the right
    if (u < 120 && scene.is_person[i] == 0) scene.frame.depth_mm[i] = 0;     // no reading
  }
  const auto crop = PersonCrop::Cut(scene.frame, scene.is_person);
  ASSERT_TRUE(crop);
  const double behind_m = At(*crop, 0.0, 0.25).behind_mm - At(*crop, 0.0, -0.25).behind_mm;
  EXPECT_NEAR(behind_m, 150.0, 6.0);
  EXPECT_EQ(At(*crop, -0.5, 0.0).hidden, kCropTaps);
  EXPECT_EQ(At(*crop, 0.5, 0.0).hidden, 0);
  // 1.1 m above the axis at 2.5 m is above an image that shows 1.04.
  EXPECT_EQ(At(*crop, 0.0, 1.15).hidden, kCropTaps);
}

TEST(PersonCrop, ProjectionAndBackProjectionAreInverse) {
  const Scene scene(320, 240);
  const auto crop = PersonCrop::Cut(scene.frame, scene.is_person);
  ASSERT_TRUE(crop);
  // A hand 0.8 m before the board, on the ray that meets it 0.2 m to the left.
  const double share = (kBoard_m - 0.8) / kBoard_m;
  const Eigen::Vector3d hand_m(0.2 * share, 0.0, kBoard_m - 0.8);
  const Eigen::Vector3d at_m = crop->Project(hand_m);
  EXPECT_NEAR(at_m.x(), 0.2, 0.02);
  EXPECT_NEAR(at_m.y(), 0.0, 0.02);
  EXPECT_NEAR(at_m.z(), -0.8, 0.02);
  EXPECT_LT((crop->BackProject(at_m) - hand_m).norm(), 1e-12);
}

TEST(PersonCrop, IsEmptyWithoutAPerson) {
  Scene scene(160, 120);
  std::vector<uint8_t> nobody(scene.is_person.size(), 0);
  EXPECT_FALSE(PersonCrop::Cut(scene.frame, nobody));
  EXPECT_FALSE(PersonCrop::Cut(scene.frame, std::span(nobody).first(10)));
  std::ranges::fill(scene.frame.depth_mm, 0);
  EXPECT_FALSE(PersonCrop::Cut(scene.frame, scene.is_person));
}

}  // namespace
}  // namespace ossa::recon
