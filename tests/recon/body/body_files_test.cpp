// Custom bodies: damaged files are reported by file and line, and edited files are reloaded.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>

#include "recon/body/body_files_internal.h"
#include "recon/body/body_model.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

/// The files of a body of one triangle, for tests to damage.
class SmallBody : public testing::Test {
 protected:
  SmallBody() {
    nlohmann::json rig, weights;
    for (const std::string_view bone : kRigBoneNames) {
      const nlohmann::json end = {{"strategy", "MEAN"}, {"vertex_indices", {0}}};
      rig[std::string(bone)] = {{"head", end}, {"tail", end}};
      weights["weights"][std::string(bone)] = nlohmann::json::array();
    }
    weights["weights"]["Hips"] = {{0, 1.0}, {1, 1.0}, {2, 1.0}};
    Write("base.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng body\nf 1/1 2/2 3/3\n");
    Write("rig.cmu_mb.json", rig.dump());
    Write("weights.cmu_mb.json", weights.dump());
    fs::create_directory(folder_ / "targets");
    Write("targets/female.target", "# none\n1 -.03 0 1e-3\n");
  }

  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }

  void ExpectComplaint(const std::string& complaint) {
    test::ExpectRefused([&] { ReadBodyFiles(folder_.path()); }, complaint);
  }

  test::TemporaryFolder folder_;
};

TEST_F(SmallBody, IsRead) {
  const BodyFiles files = ReadBodyFiles(folder_.path());
  EXPECT_EQ(files.Vertices("body"), (VertexMean{0, 1, 2}));
  ASSERT_EQ(files.targets.size(), 1u);
  EXPECT_NEAR(files.targets[0].delta_dm.at(0).x(), -0.03, 1e-7);
}

TEST_F(SmallBody, CountsItsVerticesFrom1) {
  Write("base.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng body\nf 0 1 2\n");
  ExpectComplaint("base.obj: line 5: expected a vertex number from 1 up, found 0");
}

TEST_F(SmallBody, NanIsRefused) {
  Write("base.obj", "v 0 nan 0\nv 1 0 0\nv 0 1 0\ng body\nf 1 2 3\n");
  ExpectComplaint("base.obj: line 1: expected a finite number");
}

TEST_F(SmallBody, TooLargeDeltaIsRefused) {
  Write("targets/female.target", "0 0 0 0\n1 0 99 0\n");
  ExpectComplaint("female.target: line 2: expected deltas of at most 32 decimetres");
}

TEST_F(SmallBody, NegativeWeightIsRefused) {
  std::ifstream file(folder_ / "weights.cmu_mb.json");
  auto weights = nlohmann::json::parse(file);
  weights["weights"]["Spine"] = {{1, -0.5}};
  Write("weights.cmu_mb.json", weights.dump());
  ExpectComplaint("weights.cmu_mb.json: bone Spine: expected [[vertex, weight], ...], weights");
}

TEST_F(SmallBody, MissingGroupIsRefusedWithTheFile) {
  test::ExpectRefused([&] { (void)ReadBodyFiles(folder_.path()).Vertices("helper-skirt"); },
                      (folder_ / "base.obj: expected a group helper-skirt").string());
}

// The model is cached beside its files, which may be edited later.
TEST(BodyModelCache, IsRebuiltIfAFileIsNewer) {
  if (!BodyIsFetched(BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  fs::copy(BodyFolder(), folder.path(), fs::copy_options::recursive);
  const double before_m = BodyModel::Load(folder.path()).Shape({}).height_m;
  std::ifstream file(folder / "base.obj");
  std::string taller;
  for (std::string line; std::getline(file, line); taller += line + "\n") {
    if (!line.starts_with("v ")) continue;
    std::istringstream numbers(line.substr(2));
    double x = 0, y = 0, z = 0;
    numbers >> x >> y >> z;
    line = "v " + std::to_string(x) + " " + std::to_string(1.1 * y) + " " + std::to_string(z);
  }
  std::ofstream(folder / "base.obj") << taller;
  fs::last_write_time(folder / "base.obj",
                      fs::last_write_time(folder / "body.cache") + std::chrono::seconds(1));
  EXPECT_GT(BodyModel::Load(folder.path()).Shape({}).height_m, 1.05 * before_m);
}

}  // namespace
}  // namespace ossa::recon
