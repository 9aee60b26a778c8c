#include "tools/learning/segmented_person.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "recon/body/parts.h"

namespace ossa::tools {
namespace {

constexpr int kWidth = 80, kHeight = 60;
constexpr double kSensorHeight_m = 0.75;  // at 2 m the image ends below the floor

LabelledFrame Empty() {
  LabelledFrame frame;
  frame.depth.camera = depth::KinectV1Camera(kWidth, kHeight);
  frame.depth.depth_mm.assign(size_t{kWidth} * kHeight, 0);
  frame.parts = depth::Image<uint8_t>(kWidth, kHeight);
  frame.users = depth::Image<uint8_t>(kWidth, kHeight);
  return frame;
}

// Columns [u0, u1) and rows [v0, v1) of a surface at one depth.
void Put(int u0, int u1, int v0, int v1, uint16_t depth_mm, uint8_t part, LabelledFrame* frame) {
  for (int v = v0; v < v1; ++v) {
    for (int u = u0; u < u1; ++u) {
      frame->depth.depth_mm[static_cast<size_t>(v * kWidth + u)] = depth_mm;
      frame->parts.at(u, v) = part;
      frame->users.at(u, v) = part == 0 ? 0 : 1;
    }
  }
}

bool IsPersons(const std::vector<uint8_t>& is_person, int u, int v) {
  return is_person.at(static_cast<size_t>(v * kWidth + u)) != 0;
}

TEST(SegmentedPerson, IncludesHeldObjectsAndExcludesOccluders) {
  LabelledFrame frame = Empty();
  Put(30, 40, 10, 40, 2000, 4, &frame);
  Put(40, 50, 20, 26, 1980, recon::kOtherPart, &frame);  // in touch with the body
  Put(50, 56, 20, 26, 1960, recon::kOtherPart, &frame);  // goes on from there
  Put(20, 45, 40, 50, 1500, recon::kOtherPart, &frame);  // half a metre before it
  const auto is_person = SegmentedPerson(frame, 1);
  EXPECT_TRUE(IsPersons(is_person, 35, 15));
  EXPECT_TRUE(IsPersons(is_person, 45, 22));
  EXPECT_TRUE(IsPersons(is_person, 55, 22));
  EXPECT_FALSE(IsPersons(is_person, 35, 45));
  EXPECT_EQ(std::count(is_person.begin(), is_person.end(), 1), 10 * 30 + 16 * 6);
  const auto nobody = SegmentedPerson(frame, 2);
  EXPECT_EQ(std::count(nobody.begin(), nobody.end(), 1), 0);
}

TEST(SegmentedPerson, ExcludesPixelsWithoutAReading) {
  LabelledFrame frame = Empty();
  Put(30, 40, 10, 40, 2000, 4, &frame);
  frame.depth.depth_mm[20 * kWidth + 35] = 0;
  EXPECT_FALSE(IsPersons(SegmentedPerson(frame, 1), 35, 20));
}

TEST(SegmentedPerson, ExcludesSolesOnTheFloor) {
  LabelledFrame frame = Empty();
  Put(38, 42, 0, kHeight, 2000, 30, &frame);
  const auto without = SegmentedPerson(frame, 1);
  frame.floor = Eigen::Vector4d(0, 1, 0, kSensorHeight_m);
  const auto with = SegmentedPerson(frame, 1);
  int soles = 0, legs = 0;
  for (int v = 0; v < kHeight; ++v) {
    const double height_m =
        kSensorHeight_m + depth::BackProject(frame.depth.camera, 40, v, 2000).y();
    EXPECT_TRUE(IsPersons(without, 40, v));
    if (height_m < 0.02) {
      EXPECT_FALSE(IsPersons(with, 40, v)) << height_m;
      ++soles;
    } else if (height_m > 0.15) {  // between them the sensor's tolerance decides
      EXPECT_TRUE(IsPersons(with, 40, v)) << height_m;
      ++legs;
    }
  }
  EXPECT_GT(soles, 1);
  EXPECT_GT(legs, 1);
}

TEST(LayFloor, FillsOnlyPixelsWithoutAReading) {
  LabelledFrame frame = Empty();
  Put(30, 40, 10, 58, 2000, 4, &frame);
  LabelledFrame unknown = frame;
  LayFloor(&unknown);
  EXPECT_EQ(unknown.depth.depth_mm, frame.depth.depth_mm);

  frame.floor = Eigen::Vector4d(0, 1, 0, kSensorHeight_m);
  LayFloor(&frame);
  const depth::DepthView view = frame.depth.view();
  EXPECT_EQ(view.at(35, 55), 2000);
  EXPECT_EQ(view.at(20, 5), 0);  // above the horizon
  const uint16_t floor_mm = view.at(20, 55);
  ASSERT_NE(floor_mm, 0);
  EXPECT_NEAR(depth::BackProject(frame.depth.camera, 20, 55, floor_mm).y(), -kSensorHeight_m, 1e-3);
  EXPECT_EQ(frame.users.at(20, 55), 0);
}

}  // namespace
}  // namespace ossa::tools
