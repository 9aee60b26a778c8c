#include "depth/sensor/readers/k4a_calibration.h"

#include <gtest/gtest.h>

#include "tests/support/refused.h"

namespace ossa::depth {
namespace {

// Relative to a sensor of 1024 pixels: centre, focal lengths, then the distortion.
std::string Calibration(const std::string& lens, const std::string& more = "") {
  return R"({"CalibrationInformation":{"Cameras":[)"
         R"({"Purpose":"CALIBRATION_CameraPurposePhotoVideo"},)"
         R"({"Purpose":"CALIBRATION_CameraPurposeDepth",)" +
         more + R"("Intrinsics":{"ModelParameters":[0.5,0.5,0.492,0.493,)" + lens + "]}}]}}";
}

constexpr const char* kNoLens = "0,0,0,0,0,0,0,0,0,0";

TEST(K4aCalibration, DependsOnTheDepthMode) {
  const Camera narrow = ReadK4aCalibration(Calibration(kNoLens), 640, 576).pinhole;
  EXPECT_NEAR(narrow.fx, 0.492 * 1024, 1e-9);
  EXPECT_NEAR(narrow.fy, 0.493 * 1024, 1e-9);
  EXPECT_NEAR(narrow.cx, 512 - 192 - 0.5, 1e-9);
  EXPECT_NEAR(narrow.cy, 512 - 180 - 0.5, 1e-9);
  const Camera binned = ReadK4aCalibration(Calibration(kNoLens), 320, 288).pinhole;
  EXPECT_NEAR(binned.fx, 0.492 * 512, 1e-9);
  EXPECT_NEAR(binned.cx, 256 - 96 - 0.5, 1e-9);
  EXPECT_NEAR(ReadK4aCalibration(Calibration(kNoLens), 512, 512).pinhole.cx, 255.5, 1e-9);
  EXPECT_NEAR(ReadK4aCalibration(Calibration(kNoLens), 1024, 1024).pinhole.cx, 511.5, 1e-9);
}

TEST(K4aCalibration, WithoutDistortionOnlyPixelsBeyondTheRadiusAreLost) {
  const std::string calibration = Calibration(kNoLens, R"("MetricRadius":0.5,)");
  const auto map = UndistortionMap(ReadK4aCalibration(calibration, 320, 288));
  EXPECT_EQ(map[143 * 320 + 160], 143 * 320 + 160);
  EXPECT_EQ(map[0], -1);
}

// r is mapped to r (1 + k1 r^2): larger displacements at larger r.
TEST(K4aCalibration, UndistortsTheLens) {
  const LensCamera lens = ReadK4aCalibration(Calibration("-0.2,0,0,0,0,0,0,0,0,0"), 640, 576);
  const auto map = UndistortionMap(lens);
  const int u = 520, v = 332;
  const double x = (u - lens.pinhole.cx) / lens.pinhole.fx;
  const double y = (v - lens.pinhole.cy) / lens.pinhole.fy;
  const double seen_u = lens.pinhole.cx + lens.pinhole.fx * x * (1 - 0.2 * (x * x + y * y));
  EXPECT_EQ(map[v * 640 + u] % 640, static_cast<int>(std::lround(seen_u)));
  std::vector<uint16_t> depth(640 * 576, 0);
  depth[static_cast<size_t>(map[v * 640 + u])] = 1234;
  EXPECT_EQ(Undistorted(depth, map)[v * 640 + u], 1234);
}

TEST(K4aCalibration, RefusesOtherTextAndNamesWhatIsMissing) {
  const auto read = [](const std::string& text, int width = 640) {
    return [=] { ReadK4aCalibration(text, width, 576); };
  };
  test::ExpectRefused(read("not"), "expected JSON");
  test::ExpectRefused(read("[]"), "Cameras");
  test::ExpectRefused(read(R"({"CalibrationInformation":{"Cameras":[1,{}]}})"), "Purpose");
  test::ExpectRefused(read(Calibration("1,2")), "14 ModelParameters");
  test::ExpectRefused(read(Calibration("null,0,0,0,0,0,0,0,0,0")), "finite");
  test::ExpectRefused(read(Calibration(kNoLens), 641), "depth mode of 641x576");
}

}  // namespace
}  // namespace ossa::depth
