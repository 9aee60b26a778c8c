#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/error.h"
#include "recon/refine/close_look.h"
#include "tests/recon/models/random_network.h"
#include "tests/recon/refine/look_scene.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::RandomNetwork;
using test::Silent;
using test::SilentAndTold;

TEST(CloseLook, IsKeptInAFile) {
  const ossa::test::TemporaryFolder folder;
  CloseLook look = Silent();
  look.glances[0][2].layers[0].weight(1, 5) = 0.5F;
  look.Save(folder / "a.ossalook");
  EXPECT_TRUE(CloseLook::IsOne(folder / "a.ossalook"));
  const CloseLook read = CloseLook::Load(folder / "a.ossalook");
  EXPECT_EQ(read.people, 7U);
  EXPECT_NEAR(read.glances[0][2].layers[0].weight(1, 5), 0.5F, 0.5F / 500.0F);
  read.Save(folder / "b.ossalook");
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.ossalook"), bytes("b.ossalook"));
  std::ofstream(folder / "short.ossalook", std::ios::binary) << bytes("a.ossalook").substr(0, 100);
  EXPECT_THROW(CloseLook::Load(folder / "short.ossalook"), InputError);

  EXPECT_TRUE(read.bones.empty());
  look.bones = RandomNetwork(2, 6, kBoneInputs, kMeasuredBones.size());
  look.measured = 9;
  look.Save(folder / "bones.ossalook");
  const CloseLook bones = CloseLook::Load(folder / "bones.ossalook");
  EXPECT_EQ(bones.measured, 9U);
  const Eigen::VectorXf some = Eigen::VectorXf::Random(kBoneInputs);
  EXPECT_LT((bones.bones.Run(some) - look.bones.Run(some)).norm(), 0.1F);

  look = SilentAndTold();
  look.told[0][4].layers[0].weight(2, kToldInputs - 1) = 1.0F;
  look.Save(folder / "told.ossalook");
  const CloseLook told = CloseLook::Load(folder / "told.ossalook");
  ASSERT_EQ(told.told.size(), 1U);
  EXPECT_NEAR(told.told[0][4].layers[0].weight(2, kToldInputs - 1), 1.0F, 1.0F / 500.0F);
}

TEST(CloseLook, OfTheVersionsBeforeIsReadAndOlderOnesAreRefused) {
  const ossa::test::TemporaryFolder folder;
  SilentAndTold().Save(folder / "now.ossalook");
  ContainerFormat format = {{'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, CloseLook::kVersion, "look"};
  std::vector<std::byte> payload =
      Decompress(ReadContainer(folder / "now.ossalook", format), "now", "look");
  format.version = 5;  // not compressed
  WriteContainer(folder / "before.ossalook", format, payload);
  EXPECT_EQ(CloseLook::Load(folder / "before.ossalook").told.size(), 1U);

  CloseLook look = SilentAndTold();
  look.told.clear();
  look.Save(folder / "untold.ossalook");
  format.version = CloseLook::kVersion;
  payload = Decompress(ReadContainer(folder / "untold.ossalook", format), "untold", "look");
  payload.resize(payload.size() - sizeof(uint32_t));  // how many glances are told
  format.version = CloseLook::kOldestVersion;
  WriteContainer(folder / "old.ossalook", format, payload);
  const CloseLook old = CloseLook::Load(folder / "old.ossalook");
  EXPECT_EQ(old.measured, 3U);
  EXPECT_TRUE(old.told.empty());
  old.Save(folder / "again.ossalook");
  EXPECT_NO_THROW(CloseLook::Load(folder / "again.ossalook"));
  format.version = CloseLook::kOldestVersion - 1;
  WriteContainer(folder / "older.ossalook", format, payload);
  EXPECT_THROW(CloseLook::Load(folder / "older.ossalook"), InputError);
}

TEST(CloseLook, WithOddNumbersIsRefused) {
  const ossa::test::TemporaryFolder folder;
  const auto refused_look = [&](const CloseLook& look, const char* field) {
    look.Save(folder / "odd.ossalook");
    try {
      CloseLook::Load(folder / "odd.ossalook");
      ADD_FAILURE() << field;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  const auto refused = [&](void (*spoil)(RectifiedNetwork&), const char* field) {
    CloseLook look = Silent();
    spoil(look.glances[0][4]);
    refused_look(look, field);
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  refused([](RectifiedNetwork& n) { n.input_mean[5] = std::nanf(""); }, "input means");
  refused([](RectifiedNetwork& n) { n.input_scale.conservativeResize(3); }, "input scales");
  refused([](RectifiedNetwork& n) { n.layers[0].weight(0, 5) = kInfinity; }, "unit weights");
  refused([](RectifiedNetwork& n) { n.layers[0].bias.setZero(1 << 15); }, "units");
  refused([](RectifiedNetwork& n) { n.layers[1].weight.setZero(4, 2); }, "output weights");
  refused([](RectifiedNetwork& n) { n.layers.resize(9, n.layers[1]); }, "layers");
  CloseLook look = Silent();
  look.measured = 1;
  look.bones = RandomNetwork(1, 4, kBoneInputs, 3);
  refused_look(look, "output weights");
  look.bones = RandomNetwork(1, 4, kBoneInputs - 1, kMeasuredBones.size());
  refused_look(look, "input means");

  for (const size_t glances : {size_t{0}, CloseLook::kMostGlances + 1}) {
    look = Silent();
    look.glances.resize(glances, Silent().glances[0]);
    refused_look(look, "glances");
  }
  look = SilentAndTold();
  look.told.resize(CloseLook::kMostGlances + 1, look.told[0]);
  refused_look(look, "told glances");
  look = SilentAndTold();
  look.told[0][1].input_mean = Eigen::VectorXf::Zero(kLookInputs);
  refused_look(look, "input means");
}

}  // namespace
}  // namespace ossa::recon
