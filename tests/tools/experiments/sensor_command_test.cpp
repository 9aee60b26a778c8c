// `ossa experiment sensor` measures a sensor whose steps and shadows are known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "depth/image/depth_png.h"
#include "recon/body/body_model.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

constexpr double kFocal_px = 525, kShadowScale_mm = 75 * kFocal_px;  // f b

// A wall from 0.6 m at the left to 3.9 m at the right, in depths 2.9e-6 z² apart, and before its
// far end a board at 1 m that throws its shadow to the left.
void WriteKnownSensor(const std::filesystem::path& path) {
  depth::Image<uint16_t> image(640, 48);
  constexpr double kInverse = 1 / 2.9e-6;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double wall_mm = 600 + 3300.0 * u / image.width;
      image.at(u, v) = static_cast<uint16_t>(kInverse / std::floor(kInverse / wall_mm));
    }
    const int board_u = 500, far_mm = image.at(board_u, v);
    const int shadow_px = static_cast<int>(kShadowScale_mm * (1.0 / 1000 - 1.0 / far_mm));
    for (int u = board_u - shadow_px; u < board_u; ++u) image.at(u, v) = 0;
    for (int u = board_u; u < image.width; ++u) image.at(u, v) = 1000;
  }
  depth::WriteDepthPng(path, {image.data.data(), image.width, image.height, image.width});
}

double Cell(const nlohmann::json& table, size_t row, size_t column) {
  return std::stod(table["rows"][row][column].get<std::string>());
}

TEST(SensorCommand, MeasuresDepthStepsAndShadowOfASimulatedSensor) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  for (const char* name : {"skeltrack_v1", "pcl_five_people", "pcl_person"}) {
    const std::filesystem::path frames = folder / "real/depth_frames" / name;
    std::filesystem::create_directories(frames);
    if (std::string(name) == "pcl_person") WriteKnownSensor(frames / "a.png");
  }
  const std::string parameters = folder / "p.toml";
  std::ofstream(parameters) << "frames = 2\n";
  const auto run = test::RunOssa({"experiment", "sensor", "--out", folder / "out", "--shared",
                                  folder.path(), "--parameters", parameters, "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto tables = nlohmann::json::parse(std::ifstream(folder / "out/summary.json"))["tables"];
  // Whole millimetres make steps of 2.6 mm at 1 m alternate between 2 and 3.
  EXPECT_NEAR(Cell(tables[0], 2, 1), 2.9, 0.3);
  EXPECT_NEAR(Cell(tables[0], 3, 1), 2.9, 0.15);
  EXPECT_NEAR(Cell(tables[1], 0, 1), 1.0, 0.1) << "the shadow, but for parts of a pixel";
  EXPECT_EQ(tables[1]["rows"][1][1], "-") << "nothing at the right";
}

TEST(SensorCommand, ReportsMissingInputInOneLine) {
  const test::TemporaryFolder folder;
  for (const auto& [arguments, expected] :
       {std::pair<std::vector<std::string>, std::string>{{}, "--shared"},
        {{"--shared", folder.path()}, "skeltrack_v1"}}) {
    std::vector<std::string> words = {"experiment", "sensor", "--out", folder / "out", "--quiet"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const auto run = test::RunOssa(words);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(expected), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace ossa
