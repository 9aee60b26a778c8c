// A body whose feet and knees point to its back is a mirror image.
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_jsonl.h"
#include "tests/recon/noisy_sensor.h"

namespace ossa::recon {
namespace {

using Change = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// The warnings about somebody with bent knees, each joint moved by `change`.
std::string WarningsOf(const Change& change, int frames = 30, double knee_rad = 0.4) {
  Posture posture = test::InFrontOfCamera(test::Gesture(0.5, 0.7, 0.3, knee_rad));
  for (Eigen::Vector3d& place_m : posture.position_m) place_m = change(place_m);
  std::string text;
  for (const SkeletonFrame& frame :
       test::SequenceOf(std::vector<Posture>(static_cast<size_t>(frames), posture)).frames) {
    text += SkeletonJsonLine(frame) + "\n";
  }
  std::istringstream stream(text);
  std::string warnings;
  for (const std::string& warning : ReadSkeletonStream(stream, "file").warnings)
    warnings += warning;
  return warnings;
}

TEST(MirroredBody, IsReportedWhateverAxisIsExchanged) {
  for (const Eigen::Vector3d& axes :
       {Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(-1, -1, -1)}) {
    EXPECT_NE(WarningsOf([&](const Eigen::Vector3d& p) {
                return axes.cwiseProduct(p).eval();
              }).find("feet point and knees bend backwards"),
              std::string::npos)
        << axes.transpose();
  }
}

TEST(MirroredBody, IsNoTurnedOne) {
  for (const double turn_rad : {0.0, 1.5, 3.1}) {
    const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d(0.2, 1, 0).normalized());
    EXPECT_EQ(WarningsOf([&](const Eigen::Vector3d& p) { return (turn * p).eval(); }), "")
        << turn_rad;
  }
}

TEST(MirroredBody, IsNotJudgedByFewFramesOrStraightLegs) {
  const Change mirrored = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(-p.x(), p.y(), p.z());
  };
  EXPECT_EQ(WarningsOf(mirrored, 10), "");
  EXPECT_EQ(WarningsOf(mirrored, 30, 0.0), "");
}

}  // namespace
}  // namespace ossa::recon
