#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/error.h"
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "forest/prune.h"
#include "forest/targets.h"
#include "tests/forest/ball_figure.h"
#include "tests/support/temporary_folder.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

// The message of the InputError thrown by `act`; it must be one line.
template <typename Act>
std::string Refusal(const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "expected an InputError";
  return {};
}

std::string RefusalOfBytes(const std::vector<char>& bytes) {
  return Refusal([&] { ReadForestModel(std::as_bytes(std::span(bytes)), "body.ossa"); });
}

std::string RefusalOfData(ForestData data) {
  return Refusal([&] { ForestModel(std::move(data), "body.ossa"); });
}

TEST(ForestModelFile, RoundTripIsExact) {
  const std::vector<char> bytes = test::ToBytes(BallModel());
  const ForestModel read = ReadForestModel(std::as_bytes(std::span(bytes)), "body.ossa");
  EXPECT_EQ(test::ToBytes(read), bytes);
}

TEST(FindTargets, AreInTheOrderOfTheNamesOrRefused) {
  const ForestModel model = BallModel();
  ASSERT_GE(model.targets().size(), 2U);
  const std::array<std::string_view, 2> names = {model.targets()[1].name, model.targets()[0].name};
  EXPECT_EQ(FindTargets(model, names, "body.ossa"), (std::vector<size_t>{1, 0}));
  const std::array<std::string_view, 1> missing = {"Tail"};
  EXPECT_EQ(Refusal([&] { FindTargets(model, missing, "body.ossa"); }),
            "body.ossa: targets: expected one named 'Tail', found none");
}

TEST(ForestModelFile, RunOnlyModelGivesTheSameResults) {
  const ossa::test::TemporaryFolder folder;
  const auto path = folder.path() / "body.ossa";
  WriteForestModel(path, BallModel());
  const ForestModel to_run = ReadForestModel(path, ModelUse::kRunOnly);
  EXPECT_TRUE(to_run.data().trees.front().entries.empty());
  const TrainingImage image = BallFigures(1, 9).Read(0);
  const auto classify = [&](const ForestModel& model) {
    return Classify(model, test::MakeView(image), image.camera, test::ObjectPixels(image));
  };
  EXPECT_EQ(classify(to_run).label, classify(BallModel()).label);
  EXPECT_EQ(classify(to_run).mass, classify(BallModel()).mass);
  EXPECT_THROW(WriteForestModel(folder.path() / "again.ossa", to_run), std::logic_error);
}

TEST(ForestModelFile, EveryTruncationIsRefusedByName) {
  const std::vector<char> whole = test::ToBytes(BallModel());
  for (const size_t size : {size_t{0}, size_t{5}, size_t{30}, whole.size() / 2, whole.size() - 1}) {
    const std::vector<char> part(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_NE(RefusalOfBytes(part).find("body.ossa"), std::string::npos) << size << " bytes";
  }
}

TEST(ForestModelFile, EveryFlippedBitIsRefused) {
  const std::vector<char> whole = test::ToBytes(BallModel());
  for (size_t at = 0; at < whole.size(); at += whole.size() / 40) {
    std::vector<char> damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    EXPECT_NE(RefusalOfBytes(damaged).find("body.ossa"), std::string::npos) << "byte " << at;
  }
}

TEST(ForestModelFile, AnotherVersionIsRefusedAsSuch) {
  std::vector<char> other = test::ToBytes(BallModel());
  constexpr size_t kVersionAt = 12;  // after magic and byte-order mark
  other[kVersionAt] = 77;
  EXPECT_NE(RefusalOfBytes(other).find("version"), std::string::npos);
}

// The payload of a version-1 file, unpacked: one split on the depth itself, two leaves.
PayloadWriter OldPayload() {
  PayloadWriter payload;
  payload.PutString("{}");
  for (const auto& names : {std::vector<std::string>{"background", "near", "far"}, {"any"}}) {
    payload.Put<uint32_t>(static_cast<uint32_t>(names.size()));
    for (const std::string& name : names) payload.PutString(name);
  }
  payload.PutVector(std::vector<float>{1.0F});  // context prior
  payload.Put(20.0F);                           // evidence scale
  payload.Put<uint16_t>(10000);                 // background, mm
  payload.Put<uint32_t>(0);                     // targets
  payload.Put<uint32_t>(1);                     // trees
  payload.PutVector(std::vector<uint8_t>{0, 1, 1});
  payload.PutVector(std::vector<int32_t>{0, 1});
  for (const auto& value : std::vector<std::vector<int16_t>>{{48}, {0}, {0}, {0}, {25}}) {
    payload.PutVector(value);
  }
  payload.PutVector(std::vector<uint16_t>{2, 1});  // entries a leaf
  payload.PutVector(std::vector<uint16_t>{127 << 9 | 2, 30 << 9 | 1, 127 << 9 | 1});
  payload.Put<int32_t>(0);  // vote depth
  payload.PutVector(std::vector<Vote>{});
  return payload;
}

TEST(ForestModelFile, TreesOfOlderVersionsAreRead) {
  const ossa::test::TemporaryFolder folder;
  const auto path = folder.path() / "old.ossa";
  WriteContainer(path, {{'o', 's', 's', 'a', 'f', 'r', 's', 't'}, 1, "forest model"},
                 Compress(OldPayload().bytes(), 3));
  const Tree tree = ReadForestModel(path).data().trees.at(0);
  EXPECT_EQ(tree.nodes, (std::vector<Node>{
                            {{48, 0}, {0, 0}, 25, 0, 1}, {{}, {}, 0, 0, ~0}, {{}, {}, 0, 0, ~1}}));
  EXPECT_EQ(tree.entry_begin, (std::vector<uint32_t>{0, 2, 3}));
}

// Older files end sooner: the payload of version 4 before the relabelling (five empty arrays, their
// counts of 8 bytes each), that of version 3 before the refinement as well (two empty arrays and
// the number of layers).
class OlderFile : public testing::TestWithParam<std::pair<uint32_t, size_t>> {};

TEST_P(OlderFile, IsReadWithoutWhatItLacks) {
  const auto [version, missing_bytes] = GetParam();
  const ossa::test::TemporaryFolder folder;
  const auto path = folder.path() / "model.ossa";
  const std::array<char, 8> magic = {'o', 's', 's', 'a', 'f', 'r', 's', 't'};
  WriteForestModel(path, BallModel());
  std::vector<std::byte> payload =
      Decompress(ReadContainer(path, {magic, 5, "forest model"}), "model", "forest model");
  payload.resize(payload.size() - missing_bytes);
  WriteContainer(path, {magic, version, "forest model"}, Compress(payload, 3));
  EXPECT_EQ(test::ToBytes(ReadForestModel(path)), test::ToBytes(BallModel()));
}
INSTANTIATE_TEST_SUITE_P(ForestModelFile, OlderFile,
                         testing::Values(std::pair(4U, size_t{40}), std::pair(3U, size_t{60})));

TEST(ForestModelFile, FileOfAnotherKindIsRefused) {
  const std::string text = "this is a letter, not a forest; it is long enough to hold a header";
  EXPECT_NE(RefusalOfBytes({text.begin(), text.end()}).find("forest model"), std::string::npos);
}

TEST(ForestModel, RefusesNan) {
  ForestData data = BallModel().data();
  data.targets[1].push_back_m = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(RefusalOfData(data).find("not a number"), std::string::npos);
  data = BallModel().data();
  data.targets[0].correct.weight[2] = std::numeric_limits<float>::infinity();
  EXPECT_NE(RefusalOfData(data).find("not a number"), std::string::npos);
}

TEST(ForestModel, RefusesMoreLeavesThanItsLinesCanCount) {
  ForestData data = BallModel().data();
  data.trees.front().entry_begin.assign((size_t{1} << 24U) + 2, 0);
  EXPECT_NE(RefusalOfData(std::move(data)).find("16777217"), std::string::npos);
}

TEST(ForestModel, RefusesVotesThatDoNotFitItsContexts) {
  ForestData data = BallModel().data();
  data.trees[0].votes.resize(data.trees[0].votes.size() / 2);
  EXPECT_NE(RefusalOfData(data).find("votes: expected"), std::string::npos);
}

TEST(ForestModel, RefusesBackgroundInALeaf) {
  ForestData data = BallModel().data();
  data.trees[0].entries[0] = 5U << 9U;  // class 0
  EXPECT_NE(RefusalOfData(data).find("background"), std::string::npos);
}

TEST(FitInto, KeepsAModelThatFits) {
  const ForestModel fitted = FitInto(BallModel(), FileSize(BallModel().data()));
  EXPECT_EQ(test::ToBytes(fitted), test::ToBytes(BallModel()));
}

TEST(FitInto, DropsRareEntriesUntilTheFileFits) {
  const uint64_t limit = FileSize(BallModel().data()) * 97 / 100;
  const ForestModel fitted = FitInto(BallModel(), limit);
  EXPECT_LE(test::ToBytes(fitted).size(), limit);
  for (size_t t = 0; t < fitted.data().trees.size(); ++t) {
    const std::vector<uint32_t>& kept = fitted.data().trees[t].entry_begin;
    const std::vector<uint32_t>& whole = BallModel().data().trees[t].entry_begin;
    for (size_t leaf = 0; leaf + 1 < whole.size(); ++leaf) {
      EXPECT_EQ(kept[leaf] < kept[leaf + 1], whole[leaf] < whole[leaf + 1]) << "a leaf emptied";
    }
  }
}

TEST(FitInto, ThrowsIfOneEntryPerLeafDoesNotFit) {
  EXPECT_NE(Refusal([] { FitInto(BallModel(), 200); }).find("does not fit"), std::string::npos);
}

TEST(Classify, GivesTheSameBitsOnEveryPathAndThreadCount) {
  const BallFigures figures(6, 123, 320);
  for (size_t i = 0; i < figures.size(); ++i) {
    const TrainingImage image = figures.Read(i);
    const auto classify = [&](InstructionSet instructions, int threads) {
      ClassifyOptions options;
      options.instructions = instructions;
      options.threads = threads;
      return Classify(BallModel(), test::MakeView(image), image.camera, test::ObjectPixels(image),
                      options);
    };
    const Classification best = classify(InstructionSet::kBest, 1);
    EXPECT_EQ(best.label, classify(InstructionSet::kScalar, 1).label);
    EXPECT_EQ(best.mass, classify(InstructionSet::kBest, 3).mass);
  }
}

TEST(Classify, ProbabilitiesOfAPixelSumToOne) {
  const TrainingImage image = BallFigures(1, 9).Read(0);
  const Classification result =
      Classify(BallModel(), test::MakeView(image), image.camera, test::ObjectPixels(image));
  const auto classes = static_cast<size_t>(result.class_count);
  for (size_t i = 0; i < result.pixel.size(); ++i) {
    float sum = 0;
    for (size_t c = 0; c < classes; ++c) sum += result.Probability(i, c);
    EXPECT_NEAR(sum, 1.0F, 1e-5F);  // rounding of some ten floats
  }
}

TEST(Classify, SmoothingRemovesScatteredErrors) {
  const BallFigures unseen(30, 31);
  const auto errors = [&](double smoothing_m) {
    int64_t wrong = 0;
    for (size_t i = 0; i < unseen.size(); ++i) {
      const TrainingImage image = unseen.Read(i);
      ClassifyOptions options;
      options.smoothing_m = smoothing_m;
      const Classification result = Classify(BallModel(), test::MakeView(image), image.camera,
                                             test::ObjectPixels(image), options);
      for (size_t p = 0; p < result.pixel.size(); ++p) {
        wrong += result.label[p] != image.label[static_cast<size_t>(result.pixel[p])] ? 1 : 0;
      }
    }
    return wrong;
  };
  // At 128 pixels' width and 2 m a patch of 2.5 cm is three pixels wide.
  EXPECT_LT(errors(0.025), errors(0.0) * 11 / 10);
}

TEST(Classify, NoPixelsGiveNoLabels) {
  const TrainingImage image = BallFigures(1, 9).Read(0);
  EXPECT_TRUE(Classify(BallModel(), test::MakeView(image), image.camera, {}).label.empty());
}

}  // namespace
}  // namespace ossa::forest
