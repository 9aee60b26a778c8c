// The Kinect v1 without one: libfreenect's fakenect plays our dumps to our OpenNI2 driver.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "depth/error.h"
#include "depth/sensor/drivers/kinect_depth.h"
#include "depth/sensor/fakenect_dump.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::ExampleFrame;
using test::TemporaryFolder;

TEST(KinectRawDepth, IsWithinTwoPerCentOfMagnenatsPublishedFit) {
  // S. Magnenat's fit to a measured Kinect, z = 0.1236 tan(raw / 2842.5 + 1.1863) m, of which the
  // devices themselves differ by one or two per cent.
  const auto table = AverageKinectDepthTable();
  for (size_t raw = 500; raw <= 950; raw += 10) {
    const double fit_mm = 123.6 * std::tan(static_cast<double>(raw) / 2842.5 + 1.1863);
    EXPECT_NEAR(table[raw], fit_mm, 0.02 * fit_mm) << "raw " << raw;
  }
  EXPECT_EQ(table[2047], 0) << "no reading";
  EXPECT_EQ(table[1200], 0) << "behind the farthest";
}

TEST(FakenectDump, IsIndexedOnlyWhenFinished) {
  const TemporaryFolder folder;
  FakenectDump dump(folder.path(), KinectV1Camera(640, 480));
  dump.Write(ExampleFrame(0, 640, 480));
  EXPECT_FALSE(std::filesystem::exists(folder / "INDEX.txt"));
  dump.Finish();
  std::ifstream index(folder / "INDEX.txt");
  std::string accelerometer;
  std::string depth;
  index >> accelerometer >> depth;
  EXPECT_EQ(accelerometer, "a-1.000000-60000000.dump");
  EXPECT_EQ(depth, "d-1.000000-60000000.pgm");
  EXPECT_EQ(std::filesystem::file_size(folder / accelerometer), 12u);
  EXPECT_EQ(std::filesystem::file_size(folder / depth), 17u + 2 * 640 * 480);
  EXPECT_THROW(FakenectDump(folder.path(), KinectV1Camera(640, 480)), InputError);
}

TEST(FakenectDump, IsOfAKinectsSize) {
  const TemporaryFolder folder;
  EXPECT_THROW(FakenectDump(folder.path(), KinectV1Camera(320, 240)), InputError);
}

}  // namespace
}  // namespace ossa::depth
