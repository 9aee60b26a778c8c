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

TEST(RefinementCascade, SurvivesAFile) {
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

TEST(RefinementCascade, FromAboveIsAPropertyOfTheFile) {
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

TEST(RefinementCascade, StoresItsForest) {
  const ossa::test::TemporaryFolder folder;
  RefinementCascade cascade = Silent();
  cascade.forest_checksum = 0x0123456789abcdef;
  cascade.Save(folder / "a.ossarefine");
  EXPECT_EQ(RefinementCascade::Load(folder / "a.ossarefine").forest_checksum, 0x0123456789abcdef);
  EXPECT_EQ(JointRefiner::Load(folder / "a.ossarefine").forest_checksum(), 0x0123456789abcdef);
  EXPECT_EQ(JointRefiner(cascade).forest_checksum(), 0x0123456789abcdef);
}

class EarlierCascadeFiles : public testing::Test {
 protected:
  // The payload of a file of the current version, decompressed.
  std::vector<std::byte> SavedPayload(const RefinementCascade& cascade) {
    cascade.Save(folder_ / "now.ossarefine");
    return Decompress(ReadContainer(folder_ / "now.ossarefine", format_), "now", "cascade");
  }
  static std::vector<std::byte> WithoutForest(std::vector<std::byte> bytes) {
    bytes.erase(bytes.begin() + kForest, bytes.begin() + kForest + sizeof(uint64_t));
    return bytes;
  }
  static std::vector<std::byte> WithoutView(std::vector<std::byte> bytes) {
    bytes = WithoutForest(std::move(bytes));
    bytes.erase(bytes.begin() + kFromAbove, bytes.begin() + kForest);
    return bytes;
  }
  // Before stages were conditioned on bones.
  std::vector<std::byte> OldestPayload() {
    RefinementCascade cascade = SilentAndBoneConditioned();
    cascade.bone_conditioned.clear();
    std::vector<std::byte> bytes = WithoutView(SavedPayload(cascade));
    bytes.resize(bytes.size() - sizeof(uint32_t));  // the number of conditioned stages
    return bytes;
  }
  std::string Written(uint32_t version, const std::vector<std::byte>& payload) {
    ContainerFormat format = format_;
    format.version = version;
    WriteContainer(folder_ / "earlier.ossarefine", format, payload);
    return folder_ / "earlier.ossarefine";
  }

  static constexpr auto kFromAbove = static_cast<std::ptrdiff_t>(sizeof(uint64_t));  // after people
  static constexpr auto kForest = static_cast<std::ptrdiff_t>(kFromAbove + sizeof(uint32_t));
  const ossa::test::TemporaryFolder folder_;
  const ContainerFormat format_ = {
      {'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, RefinementCascade::kVersion, "cascade"};
};

TEST_F(EarlierCascadeFiles, WithoutAForestAreRead) {
  const auto file =
      Written(7, Compress(WithoutForest(SavedPayload(SilentAndBoneConditioned())), 3));
  EXPECT_EQ(RefinementCascade::Load(file).bone_conditioned.size(), 1U);
  EXPECT_EQ(RefinementCascade::Load(file).forest_checksum, 0U);
  EXPECT_EQ(JointRefiner::Load(file).forest_checksum(), 0U);
}

TEST_F(EarlierCascadeFiles, WithoutAViewAreReadAsLevel) {
  const auto file = Written(6, Compress(WithoutView(SavedPayload(SilentAndBoneConditioned())), 3));
  EXPECT_EQ(RefinementCascade::Load(file).bone_conditioned.size(), 1U);
  EXPECT_FALSE(JointRefiner::Load(file).from_above());
}

TEST_F(EarlierCascadeFiles, WithoutCompressionAreRead) {
  const auto file = Written(5, WithoutView(SavedPayload(SilentAndBoneConditioned())));
  EXPECT_EQ(RefinementCascade::Load(file).bone_conditioned.size(), 1U);
}

TEST_F(EarlierCascadeFiles, OldestSupportedVersionIsReadAndSavedAgain) {
  const RefinementCascade old =
      RefinementCascade::Load(Written(RefinementCascade::kOldestVersion, OldestPayload()));
  EXPECT_EQ(old.measured, 3U);
  EXPECT_TRUE(old.bone_conditioned.empty());
  old.Save(folder_ / "again.ossarefine");
  EXPECT_NO_THROW(RefinementCascade::Load(folder_ / "again.ossarefine"));
}

TEST_F(EarlierCascadeFiles, OlderThanTheOldestSupportedAreRefused) {
  const auto file = Written(RefinementCascade::kOldestVersion - 1, OldestPayload());
  EXPECT_THROW(RefinementCascade::Load(file), InputError);
}

// Saves the cascade and expects that reading it names the field.
void ExpectRefused(const RefinementCascade& cascade, const char* field) {
  const ossa::test::TemporaryFolder folder;
  cascade.Save(folder / "odd.ossarefine");
  try {
    RefinementCascade::Load(folder / "odd.ossarefine");
    ADD_FAILURE() << field;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
  }
}

TEST(RefinementCascade, WithAnInvalidNetworkIsRefused) {
  const auto refused = [](void (*damage)(Perceptron&), const char* field) {
    RefinementCascade cascade = Silent();
    damage(cascade.stages[0][4]);
    ExpectRefused(cascade, field);
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  refused([](Perceptron& n) { n.input_mean[5] = std::nanf(""); }, "input means");
  refused([](Perceptron& n) { n.input_scale.conservativeResize(3); }, "input scales");
  refused([](Perceptron& n) { n.layers[0].weight(5, 0) = kInfinity; }, "unit weights");
  refused([](Perceptron& n) { n.layers[0].bias.setZero(1 << 15); }, "units");
  refused([](Perceptron& n) { n.layers[1].weight.setZero(2, 4); }, "output weights");
  refused([](Perceptron& n) { n.layers.resize(9, n.layers[1]); }, "layers");
}

TEST(RefinementCascade, WithABoneNetworkOfAnotherSizeIsRefused) {
  RefinementCascade cascade = Silent();
  cascade.measured = 1;
  cascade.bones = RandomPerceptron({kBoneFeatures, 4, 3});
  ExpectRefused(cascade, "output weights");
  cascade.bones = RandomPerceptron({kBoneFeatures - 1, 4, kEstimatedBones.size()});
  ExpectRefused(cascade, "input means");
}

TEST(RefinementCascade, WithTooManyOrNoStagesIsRefused) {
  for (const size_t stages : {size_t{0}, RefinementCascade::kMaxStages + 1}) {
    RefinementCascade cascade = Silent();
    cascade.stages.resize(stages, Silent().stages[0]);
    ExpectRefused(cascade, "stages");
  }
  RefinementCascade cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned.resize(RefinementCascade::kMaxStages + 1, cascade.bone_conditioned[0]);
  ExpectRefused(cascade, "bone-conditioned stages");
}

TEST(RefinementCascade, WithABoneConditionedStageOfAnotherSizeIsRefused) {
  RefinementCascade cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned[0][1].input_mean.setZero(kStageFeatures);
  ExpectRefused(cascade, "input means");
}

}  // namespace
}  // namespace ossa::recon
