// The Kinect v1 without one: libfreenect's fakenect plays our dumps to our OpenNI2 driver.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "depth/base/error.h"
#include "depth/sensor/fakenect_dump.h"
#include "depth/sensor/kinect_depth.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
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

TEST(FakenectDump, HasTheSizeOfAKinectsImages) {
  const TemporaryFolder folder;
  EXPECT_THROW(FakenectDump(folder.path(), KinectV1Camera(320, 240)), InputError);
}

// Debian puts fakenect's libfreenect beside the real one.
#ifdef __aarch64__
const std::string kFakenect = "/usr/lib/aarch64-linux-gnu/fakenect";
#else
const std::string kFakenect = "/usr/lib/x86_64-linux-gnu/fakenect";
#endif

TEST(KinectDriver, ProvidesSerialTiltAndAccelerometerToOpenNi2Programs) {
  const std::string probe = (test::BinaryFolder() / "bin/kinect_probe").string();
  if (!std::filesystem::is_directory(kFakenect) || !std::filesystem::exists(probe)) {
    GTEST_SKIP() << "no fakenect or no libfreenect: " << kFakenect;
  }
  const TemporaryFolder folder;
  FakenectDump dump(folder.path(), KinectV1Camera(640, 480));
  for (int i = 0; i < 30; ++i) dump.Write(ExampleFrame(i, 640, 480));
  dump.Finish();
  const test::CommandResult result = test::RunProgram(
      {"/usr/bin/env",
       "LD_LIBRARY_PATH=" + kFakenect + ":" + (test::BinaryFolder() / "lib/openni2").string(),
       "FAKENECT_PATH=" + folder.path().string(), probe, "freenect://0"});
  EXPECT_EQ(result.exit_status, 0) << result.out;
  const auto says = [&](const std::string& words) {
    EXPECT_NE(result.out.find(words + "\n"), std::string::npos) << result.out;
  };
  says("serial 0");  // fakenect has none: the index
  says("tilt 0.0");
  says("accelerometer 0.00 9.81 0.00");  // the dump's: it stands level
  says("tilts to 10: 1, to 60: 0");      // the motor's range ends at 27 degrees
  says("registered 0, f 576");           // as the depth camera sees
  says("registered 1, f 533");           // as the colour camera does
  says("stream 640x480, 30 Hz, millimetres 1, below 10001");
}

}  // namespace
}  // namespace ossa::depth
