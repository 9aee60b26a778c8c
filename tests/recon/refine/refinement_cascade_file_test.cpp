#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/error.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/recon/refine/refinement_scene.h"
#include "tests/support/perceptrons.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using ossa::test::RandomPerceptron;
using test::Silent;
using test::SilentAndBoneConditioned;

TEST(RefinementCascade, IsKeptInAFile) {
  const ossa::test::TemporaryFolder folder;
  RefinementCascade cascade = Silent();
  cascade.stages[0][2].layers[0].weight(5, 1) = 0.5F;
  cascade.Save(folder / "a.ossarefine");
  EXPECT_TRUE(RefinementCascade::IsFile(folder / "a.ossarefine"));
  const RefinementCascade read = RefinementCascade::Load(folder / "a.ossarefine");
  EXPECT_EQ(read.people, 7U);
  EXPECT_NEAR(read.stages[0][2].layers[0].weight(5, 1), 0.5F, 0.5F / 500.0F);
  read.Save(folder / "b.ossarefine");
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.ossarefine"), bytes("b.ossarefine"));
  std::ofstream(folder / "short.ossarefine", std::ios::binary)
      << bytes("a.ossarefine").substr(0, 100);
  EXPECT_THROW(RefinementCascade::Load(folder / "short.ossarefine"), InputError);

  EXPECT_TRUE(read.bones.empty());
  cascade.bones = RandomPerceptron({kBoneFeatures, 6, 6, kEstimatedBones.size()});
  cascade.measured = 9;
  cascade.Save(folder / "bones.ossarefine");
  const RefinementCascade bones = RefinementCascade::Load(folder / "bones.ossarefine");
  EXPECT_EQ(bones.measured, 9U);
  const RowMatrix some = RowMatrix::Random(1, kBoneFeatures);
  EXPECT_LT((bones.bones.Run(some) - cascade.bones.Run(some)).norm(), 0.1F);

  cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned[0][4].layers[0].weight(kBoneConditionedFeatures - 1, 2) = 1.0F;
  cascade.Save(folder / "conditioned.ossarefine");
  const RefinementCascade conditioned = RefinementCascade::Load(folder / "conditioned.ossarefine");
  ASSERT_EQ(conditioned.bone_conditioned.size(), 1U);
  EXPECT_NEAR(conditioned.bone_conditioned[0][4].layers[0].weight(kBoneConditionedFeatures - 1, 2),
              1.0F, 1.0F / 500.0F);
}

TEST(RefinementCascade, IsFromAboveWhereTheFileSaysSo) {
  const ossa::test::TemporaryFolder folder;
  RefinementCascade cascade = Silent();
  for (const bool from_above : {false, true}) {
    cascade.from_above = from_above;
    cascade.Save(folder / "a.ossarefine");
    EXPECT_EQ(RefinementCascade::Load(folder / "a.ossarefine").from_above, from_above);
    EXPECT_EQ(JointRefiner::Load(folder / "a.ossarefine").from_above(), from_above);
  }
  const ContainerFormat format = {
      {'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, RefinementCascade::kVersion, "cascade"};
  auto payload = Decompress(ReadContainer(folder / "a.ossarefine", format), "a", "cascade");
  payload[sizeof(uint64_t)] = std::byte{2};
  WriteContainer(folder / "odd.ossarefine", format, Compress(payload, 3));
  EXPECT_THROW(RefinementCascade::Load(folder / "odd.ossarefine"), InputError);
}

TEST(RefinementCascade, KnowsTheForestWhoseJointsItRefines) {
  const ossa::test::TemporaryFolder folder;
  RefinementCascade cascade = Silent();
  cascade.forest_checksum = 0x0123456789abcdef;
  cascade.Save(folder / "a.ossarefine");
  EXPECT_EQ(RefinementCascade::Load(folder / "a.ossarefine").forest_checksum, 0x0123456789abcdef);
  EXPECT_EQ(JointRefiner::Load(folder / "a.ossarefine").forest_checksum(), 0x0123456789abcdef);
  EXPECT_EQ(JointRefiner(cascade).forest_checksum(), 0x0123456789abcdef);
}

TEST(RefinementCascade, OfTheVersionsBeforeIsReadAndOlderOnesAreRefused) {
  const ossa::test::TemporaryFolder folder;
  SilentAndBoneConditioned().Save(folder / "now.ossarefine");
  ContainerFormat format = {
      {'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, RefinementCascade::kVersion, "cascade"};
  std::vector<std::byte> payload =
      Decompress(ReadContainer(folder / "now.ossarefine", format), "now", "cascade");
  constexpr auto kFromAbove = static_cast<std::ptrdiff_t>(sizeof(uint64_t));  // after the people
  constexpr auto kForest = static_cast<std::ptrdiff_t>(kFromAbove + sizeof(uint32_t));
  const auto without_forest = [](std::vector<std::byte> bytes) {
    bytes.erase(bytes.begin() + kForest, bytes.begin() + kForest + sizeof(uint64_t));
    return bytes;
  };
  const auto without_view = [&](std::vector<std::byte> bytes) {
    bytes = without_forest(std::move(bytes));
    bytes.erase(bytes.begin() + kFromAbove, bytes.begin() + kForest);
    return bytes;
  };
  format.version = 7;
  WriteContainer(folder / "seven.ossarefine", format, Compress(without_forest(payload), 3));
  EXPECT_EQ(RefinementCascade::Load(folder / "seven.ossarefine").bone_conditioned.size(), 1U);
  EXPECT_EQ(RefinementCascade::Load(folder / "seven.ossarefine").forest_checksum, 0U);
  EXPECT_EQ(JointRefiner::Load(folder / "seven.ossarefine").forest_checksum(), 0U);
  payload = without_view(std::move(payload));
  format.version = 6;
  WriteContainer(folder / "six.ossarefine", format, Compress(payload, 3));
  EXPECT_EQ(RefinementCascade::Load(folder / "six.ossarefine").bone_conditioned.size(), 1U);
  EXPECT_FALSE(JointRefiner::Load(folder / "six.ossarefine").from_above());
  format.version = 5;  // not compressed
  WriteContainer(folder / "before.ossarefine", format, payload);
  EXPECT_EQ(RefinementCascade::Load(folder / "before.ossarefine").bone_conditioned.size(), 1U);

  RefinementCascade cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned.clear();
  cascade.Save(folder / "unconditioned.ossarefine");
  format.version = RefinementCascade::kVersion;
  payload = Decompress(ReadContainer(folder / "unconditioned.ossarefine", format), "unconditioned",
                       "cascade");
  payload = without_view(std::move(payload));
  payload.resize(payload.size() - sizeof(uint32_t));  // how many stages are conditioned
  format.version = RefinementCascade::kOldestVersion;
  WriteContainer(folder / "old.ossarefine", format, payload);
  const RefinementCascade old = RefinementCascade::Load(folder / "old.ossarefine");
  EXPECT_EQ(old.measured, 3U);
  EXPECT_TRUE(old.bone_conditioned.empty());
  old.Save(folder / "again.ossarefine");
  EXPECT_NO_THROW(RefinementCascade::Load(folder / "again.ossarefine"));
  format.version = RefinementCascade::kOldestVersion - 1;
  WriteContainer(folder / "older.ossarefine", format, payload);
  EXPECT_THROW(RefinementCascade::Load(folder / "older.ossarefine"), InputError);
}

TEST(RefinementCascade, WithOddNumbersIsRefused) {
  const ossa::test::TemporaryFolder folder;
  const auto refused_cascade = [&](const RefinementCascade& cascade, const char* field) {
    cascade.Save(folder / "odd.ossarefine");
    try {
      RefinementCascade::Load(folder / "odd.ossarefine");
      ADD_FAILURE() << field;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  const auto refused = [&](void (*spoil)(Perceptron&), const char* field) {
    RefinementCascade cascade = Silent();
    spoil(cascade.stages[0][4]);
    refused_cascade(cascade, field);
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  refused([](Perceptron& n) { n.input_mean[5] = std::nanf(""); }, "input means");
  refused([](Perceptron& n) { n.input_scale.conservativeResize(3); }, "input scales");
  refused([](Perceptron& n) { n.layers[0].weight(5, 0) = kInfinity; }, "unit weights");
  refused([](Perceptron& n) { n.layers[0].bias.setZero(1 << 15); }, "units");
  refused([](Perceptron& n) { n.layers[1].weight.setZero(2, 4); }, "output weights");
  refused([](Perceptron& n) { n.layers.resize(9, n.layers[1]); }, "layers");
  RefinementCascade cascade = Silent();
  cascade.measured = 1;
  cascade.bones = RandomPerceptron({kBoneFeatures, 4, 3});
  refused_cascade(cascade, "output weights");
  cascade.bones = RandomPerceptron({kBoneFeatures - 1, 4, kEstimatedBones.size()});
  refused_cascade(cascade, "input means");

  for (const size_t stages : {size_t{0}, RefinementCascade::kMaxStages + 1}) {
    cascade = Silent();
    cascade.stages.resize(stages, Silent().stages[0]);
    refused_cascade(cascade, "stages");
  }
  cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned.resize(RefinementCascade::kMaxStages + 1, cascade.bone_conditioned[0]);
  refused_cascade(cascade, "bone-conditioned stages");
  cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned[0][1].input_mean.setZero(kStageFeatures);
  refused_cascade(cascade, "input means");
}

}  // namespace
}  // namespace ossa::recon
