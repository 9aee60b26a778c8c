// `ossa reconstruct --dynamics`: the floor is estimated, and forces of a person who stands on it.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "recon/normalise.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

using Eigen::Vector3d;
using recon::kJointCount;
using test::RunOssa;

constexpr double kTilt_rad = 0.35;  // of the camera, downwards: 20 degrees
constexpr double kMass_kg = 70.0;

/// A person who stands and sways, 3 m away, in the camera space of a camera that looks down.
Vector3d InCamera(const Vector3d& p) {
  return Eigen::AngleAxisd(kTilt_rad, Vector3d::UnitX()) * (p + Vector3d(0.0, 0.0, 3.0));
}

recon::SkeletonSequence Standing() {
  recon::SkeletonSequence sequence;
  for (int f = 0; f < 90; ++f) {
    recon::SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    recon::BodyRecord body;
    body.id = 1;
    for (size_t i = 0; i < kJointCount; ++i) {
      const Vector3d& p = recon::StandardStance().position_m[i];
      const Vector3d sway(0.01 * std::sin(2.0 * frame.time_s) * (p.y() + 1.0), 0.0, 0.0);
      body.joints[i].emplace().position_m = InCamera(p + sway);
    }
    frame.bodies.push_back(body);
    sequence.frames.push_back(frame);
  }
  return sequence;
}

class Dynamics : public testing::Test {
 protected:
  Dynamics() { recon::WriteSkeletons(in_, Standing()); }
  test::CommandResult Reconstruct(std::vector<std::string> options) const {
    std::vector<std::string> words = {"reconstruct", in_,        "--out", folder_ / "out.jsonl",
                                      "--quiet",     "--method", "none"};
    words.insert(words.end(), options.begin(), options.end());
    return RunOssa(words);
  }
  test::TemporaryFolder folder_;
  std::string in_ = folder_ / "in.jsonl";
};

std::vector<std::vector<double>> NumbersIn(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line.rfind("time_s,body,ground_force_x_n,", 0), 0U) << line;
  while (std::getline(file, line)) {
    auto& row = rows.emplace_back();
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) {
      row.push_back(cell.empty() ? NAN : std::stod(cell));
    }
  }
  return rows;
}

TEST_F(Dynamics, FindsTheFloorBelowAStandingPerson) {
  const auto run = Reconstruct({"--floor", "auto"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto floor = recon::ReadSkeletons(folder_ / "out.jsonl").frames.front().floor;
  ASSERT_TRUE(floor.has_value());
  const Vector3d up = Eigen::AngleAxisd(kTilt_rad, Vector3d::UnitX()) * Vector3d::UnitY();
  EXPECT_LT(std::acos(floor->head<3>().dot(up)), 0.06);  // the stance itself leans by that
  double lowest_m = 10.0;
  for (const auto& p : recon::StandardStance().position_m) {
    lowest_m = std::min(lowest_m, floor->dot(InCamera(p).homogeneous()));
  }
  EXPECT_NEAR(lowest_m, 0.03, 0.02);  // of a foot joint above the sole
}

TEST_F(Dynamics, GroundForceEqualsTheWeightAlongTheFloorNormal) {
  const auto run = Reconstruct(
      {"--floor", "auto", "--physics", "on", "--mass", "70", "--dynamics", folder_ / "forces.csv"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto floor = recon::ReadSkeletons(folder_ / "out.jsonl").frames.front().floor;
  const auto rows = NumbersIn(folder_ / "forces.csv");
  ASSERT_EQ(rows.size(), 90U);
  Vector3d mean = Vector3d::Zero();
  for (size_t f = 30; f < 90; ++f) mean += Vector3d(rows[f][2], rows[f][3], rows[f][4]) / 60.0;
  EXPECT_NEAR(mean.dot(floor->head<3>()), kMass_kg * 9.81, 0.02 * kMass_kg * 9.81);
  // The sum of both feet.
  for (size_t k = 2; k < 5; ++k) EXPECT_NEAR(rows[60][k], rows[60][k + 3] + rows[60][k + 6], 0.01);
}

TEST_F(Dynamics, UsesAFloorPlaneGivenByAnOption) {
  const auto run = Reconstruct({"--floor", "0,2,0,4"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto floor = recon::ReadSkeletons(folder_ / "out.jsonl").frames.back().floor;
  EXPECT_EQ(floor, Eigen::Vector4d(0.0, 1.0, 0.0, 2.0));
}

TEST_F(Dynamics, RefuseIncompleteOptions) {
  const auto refused = [&](std::vector<std::string> options, int status, const char* named) {
    const auto run = Reconstruct(std::move(options));
    EXPECT_EQ(run.exit_status, status) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
  };
  const std::string forces = folder_ / "forces.csv";
  refused({"--dynamics", forces}, 2, "--physics on");
  refused({"--mass", "70"}, 2, "--dynamics");
  refused({"--floor", "below"}, 2, "auto or a,b,c,d");
  refused({"--floor", "0,0,0,1"}, 2, "auto or a,b,c,d");
  refused({"--physics", "on", "--dynamics", forces}, 1, "expected a floor");
}

}  // namespace
}  // namespace ossa
