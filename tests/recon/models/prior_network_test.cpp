#include "recon/models/prior_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <memory>

#include "recon/models/posture_prior.h"
#include "recon/models/prior_filter.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/perceptrons.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
constexpr int kHead = 3 * (Index(Joint::kHead) - 1);  // first number of the head's bone

PosturePrior Learned() {
  static const PosturePrior prior = [] {
    PriorClip clip;
    for (double t = 0.0; t < 60.0; t += kFrame_s) clip.postures.push_back(test::Motion(t));
    return PosturePrior::Learn({clip});
  }();
  return prior;
}

/// A network with zero output.
PriorNetwork Silent(Eigen::Index units) {
  return {ossa::test::SilentPerceptron({kPriorInputs, units, kBoneDims})};
}

/// A network that always moves the head forwards by this much.
PriorNetwork HeadForward(double by_m) {
  PriorNetwork network = Silent(1);
  network.layers[1].bias[kHead + 2] = static_cast<float>(by_m / PriorNetwork::kBoneStep_m);
  return network;
}

PriorObservation Seeing(const Posture& posture) {
  PriorObservation observation;
  observation.seen = posture;
  observation.sd_m.fill(0.02);
  observation.sd_m[Joint::kHandLeft] = 0.0;
  observation.lengths_m = StandardBoneLengths();
  observation.root_sd_m = 1e-6;
  return observation;
}

TEST(PriorNetwork, IsOneRectifiedLayerOfNormalisedInputs) {
  PriorNetwork network = Silent(2);
  network.input_mean[4] = 1.0F;
  network.input_scale[4] = 2.0F;
  network.layers[0].weight(4, 0) = 1.0F;
  network.layers[0].weight(4, 1) = -1.0F;
  network.layers[0].bias[0] = 0.5F;
  network.layers[1].weight(0, 7) = 3.0F;
  network.layers[1].weight(1, 8) = 1.0F;
  network.layers[1].bias[7] = 0.25F;
  const auto said = [&](float x) {
    PriorInput input = PriorInput::Zero();
    input[4] = x;
    const BoneVector correction_m = network.Correction_m(input);
    return Eigen::Vector2d(correction_m[7], correction_m[8]);
  };
  const double step = PriorNetwork::kBoneStep_m;
  EXPECT_TRUE(said(2.0F).isApprox(step * Eigen::Vector2d(3.0 * 2.5 + 0.25, 0.0)));
  EXPECT_TRUE(said(-1.0F).isApprox(step * Eigen::Vector2d(0.25, 4.0)));
  // No more than five standard deviations are believed.
  EXPECT_TRUE(said(1e6F).isApprox(said(1.0F + 5.0F / 2.0F)));
}

TEST(PriorNetwork, InputsAreVisibilityQualityAndInnovation) {
  PriorFilter filter(std::make_shared<PosturePrior>(Learned()));
  const Posture seen = test::Motion(1.0);
  const PriorObservation observation = Seeing(seen);
  filter.Step(kFrame_s, observation);
  const PriorInput input = filter.Input();
  const Posture expected = PostureFromBones(filter.Bones_m());
  EXPECT_TRUE(input.head<kBoneDims>().isApprox(filter.Bones_m().cast<float>(), 1e-5F));
  for (size_t i = 1; i < kJointCount; ++i) {
    const bool hidden = observation.sd_m[i] == 0.0;
    EXPECT_FLOAT_EQ(input[kBoneDims + static_cast<Eigen::Index>(i - 1)],
                    hidden ? 0.0F : ObservationQuality(0.02))
        << i;
    const Eigen::Vector3d off_m = seen.position_m[i] - expected.position_m[i];
    const Eigen::Vector3f told_m = input.tail<kBoneDims>().segment<3>(FirstCoordinate(i - 1));
    EXPECT_LT((told_m.cast<double>() - (hidden ? Eigen::Vector3d::Zero() : off_m)).norm(), 1e-4)
        << i;
  }
  EXPECT_GT(ObservationQuality(0.02), ObservationQuality(0.2));
  EXPECT_EQ(ObservationQuality(0.0), 0.0F);
}

TEST(PriorNetwork, CorrectsTheFiltersPrediction) {
  PosturePrior corrected = Learned();
  corrected.network = HeadForward(0.05);
  PriorFilter without(std::make_shared<PosturePrior>(Learned()));
  PriorFilter with(std::make_shared<PosturePrior>(corrected));
  const PriorObservation observation = Seeing(test::Motion(1.0));
  without.Step(kFrame_s, observation);
  BoneVector bones_m = without.Bones_m();
  bones_m[kHead + 2] += 0.05;
  const Posture expected = Retargeted(PostureFromBones(bones_m), observation.lengths_m);
  const Posture got = with.Step(kFrame_s, observation);
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT((got.position_m[i] - expected.position_m[i]).norm(), 1e-5) << i;
  }
}

TEST(PriorNetwork, FadesOutForInferredJoints) {
  PosturePrior corrected = Learned();
  corrected.network = HeadForward(0.05);
  PriorFilter without(std::make_shared<PosturePrior>(Learned()));
  PriorFilter with(std::make_shared<PosturePrior>(corrected));
  PriorObservation observation = Seeing(test::Motion(1.0));
  const auto correction_m = [&] {
    const Posture a = with.Step(kFrame_s, observation), b = without.Step(kFrame_s, observation);
    return (a[Joint::kHead] - b[Joint::kHead]).norm();
  };
  const double whole_m = correction_m();
  ASSERT_GT(whole_m, 0.02);
  observation.guesses = true;
  double before_m = whole_m;
  for (int i = 0; i < 60; ++i) {
    const double now_m = correction_m();
    EXPECT_LT(now_m, before_m) << i;
    EXPECT_GT(now_m, 0.7 * before_m) << i;  // no jump
    before_m = now_m;
  }
  EXPECT_LT(before_m, 0.01 * whole_m);
  with.Reset();  // who guesses from the start on never hears it
  without.Reset();
  EXPECT_LT(correction_m(), 1e-9);
}

TEST(PriorNetwork, SurvivesThePriorsFile) {
  const ossa::test::TemporaryFolder folder;
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  PosturePrior prior = Learned();
  prior.Save(folder / "without.ossaprior");
  EXPECT_TRUE(PosturePrior::Load(folder / "without.ossaprior").network.empty());
  prior.network = HeadForward(0.05);
  prior.network.input_mean[2] = 0.123F;
  prior.network.layers[0].weight(3, 0) = -1.5F;
  prior.Save(folder / "with.ossaprior");
  constexpr size_t kVersionAt = 12;                      // of a checksummed container
  EXPECT_EQ(bytes("without.ossaprior")[kVersionAt], 1);  // as before there were networks
  EXPECT_EQ(bytes("with.ossaprior")[kVersionAt], 2);
  const PriorNetwork read = PosturePrior::Load(folder / "with.ossaprior").network;
  EXPECT_EQ(read.input_mean[2], 0.123F);
  EXPECT_EQ(read.layers[0].weight(3, 0), -1.5F);
  EXPECT_NEAR(read.layers[1].bias[kHead + 2], 0.5F, 0.5F / 128.0F);  // 8 bits of it
  PosturePrior::Load(folder / "with.ossaprior").Save(folder / "again.ossaprior");
  EXPECT_EQ(bytes("with.ossaprior"), bytes("again.ossaprior"));
}

TEST(PriorNetwork, InvalidNumbersAreRefused) {
  const ossa::test::TemporaryFolder folder;
  const auto refused = [&](void (*spoil)(PriorNetwork&), const char* field) {
    PosturePrior prior = Learned();
    prior.network = HeadForward(0.05);
    spoil(prior.network);
    prior.Save(folder / "odd.ossaprior");
    ossa::test::ExpectRefused([&] { PosturePrior::Load(folder / "odd.ossaprior"); }, field);
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  refused([](PriorNetwork& n) { n.input_scale[5] = std::nanf(""); }, "input scales");
  refused([](PriorNetwork& n) { n.layers[0].weight(5, 0) = kInfinity; }, "unit weights");
  refused([](PriorNetwork& n) { n.layers[0].bias.setZero(1 << 15); }, "units");
  refused([](PriorNetwork& n) { n.layers[1].weight.setZero(2, kBoneDims); }, "output weights");
  refused([](PriorNetwork& n) { n.layers[1].bias[0] = 1e9F; }, "output biases");
}

}  // namespace
}  // namespace ossa::recon
