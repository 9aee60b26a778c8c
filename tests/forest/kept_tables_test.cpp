#include "forest/kept_tables.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <iterator>
#include <memory>
#include <thread>
#include <vector>

#include "depth/base/atomic_file.h"
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "tests/forest/ball_figure.h"
#include "tests/support/temporary_folder.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

constexpr size_t kFew = 7;    // images that get tables of their own without more being made
constexpr size_t kMany = 60;  // images of a film

Classification ClassifyFigure(const ForestModel& model, size_t figure) {
  const TrainingImage image = BallFigures(kMany, 9).Read(figure);
  return Classify(model, test::MakeView(image), image.camera, test::ObjectPixels(image));
}

// Kept tables go to a folder of the test's own.
class KeptTables : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("OSSA_CACHE", cache_.c_str(), 1);
    WriteForestModel(file_, BallModel());
  }
  void TearDown() override { unsetenv("OSSA_CACHE"); }

  ForestModel ReadToKeep() const {
    ForestModel model = ReadForestModel(file_, ModelUse::kRunOnly);
    KeepTables(file_, model);
    return model;
  }
  static void ExpectRunsAsEver(const ForestModel& model, size_t figures) {
    for (size_t i = 0; i < figures; ++i) {
      const Classification now = ClassifyFigure(model, i), ever = ClassifyFigure(BallModel(), i);
      EXPECT_EQ(now.label, ever.label) << "figure " << i;
      EXPECT_EQ(now.mass, ever.mass) << "figure " << i;
      EXPECT_EQ(now.context, ever.context) << "figure " << i;
      EXPECT_EQ(now.leaf, ever.leaf) << "figure " << i;
    }
  }

  ossa::test::TemporaryFolder folder_;
  std::filesystem::path cache_ = folder_ / "cache", file_ = folder_ / "body.ossa";
};

TEST_F(KeptTables, AreNotMadeForFewImages) {
  ExpectRunsAsEver(ReadToKeep(), kFew);
  EXPECT_FALSE(std::filesystem::exists(cache_));
  EXPECT_FALSE(ReadKeptTables(file_));
}

TEST_F(KeptTables, AreWrittenAfterManyImagesWhenTheModelIsGone) {
  ExpectRunsAsEver(ReadToKeep(), kMany);
  const auto kept = ReadKeptTables(file_);
  ASSERT_TRUE(kept);
  ExpectRunsAsEver(*kept, kMany);
}

TEST_F(KeptTables, AreMadeWhileSeveralThreadsClassify) {
  const ForestModel model = ReadToKeep();
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back([&] { ExpectRunsAsEver(model, kMany); });
  for (std::thread& each : threads) each.join();
}

size_t CountFiles(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST_F(KeptTables, ReplaceLeftoversOfAKilledProcess) {
  ExpectRunsAsEver(ReadToKeep(), kMany);
  ASSERT_EQ(CountFiles(cache_), 2U);  // tables and their head
  for (const auto& entry : std::filesystem::directory_iterator(cache_)) {
    if (entry.path().extension() != ".tables") continue;
    if (const pid_t child = fork(); child == 0) {
      AtomicFile unfinished(entry.path());
      _exit(0);
    } else {
      waitpid(child, nullptr, 0);
    }
    break;
  }
  ASSERT_EQ(CountFiles(cache_), 3U);
  ExpectRunsAsEver(ReadToKeep(), kMany);
  EXPECT_EQ(CountFiles(cache_), 2U);
}

TEST_F(KeptTables, AreNotMadeByAForkedProcess) {
  auto model = std::make_unique<ForestModel>(ReadToKeep());
  ExpectRunsAsEver(*model, kFew);
  const pid_t child = fork();
  if (child == 0) {
    const bool same = ClassifyFigure(*model, kFew).mass == ClassifyFigure(BallModel(), kFew).mass;
    model.reset();
    _exit(same ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_FALSE(std::filesystem::exists(cache_));
}

TEST_F(KeptTables, AreOptional) {
  setenv("OSSA_CACHE", (file_ / "below").c_str(), 1);
  ExpectRunsAsEver(ReadToKeep(), kMany);
  EXPECT_FALSE(ReadKeptTables(file_));
}

TEST_F(KeptTables, AreNotWrittenForOtherModels) {
  ExpectRunsAsEver(ReadForestModel(file_, ModelUse::kRunOnly), kMany);
  EXPECT_FALSE(std::filesystem::exists(cache_));
}

}  // namespace
}  // namespace ossa::forest
