#include "forest/proposals/relabel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "depth/base/error.h"
#include "forest/proposals/relabel_internal.h"
#include "forest/training/train.h"
#include "forest/training/validation_internal.h"
#include "tests/forest/ball_figure.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

// The ball model with proposals and pose priors learned.
const ForestModel& Arranged() {
  static const ForestModel model = LearnProposals(
      LearnPosePriors(BallModel(), BallFigures(300, 9), 300, 0), BallFigures(100, 5), 100, 0);
  return model;
}

const ForestModel& WithPrior() {
  static const ForestModel model = LearnRelabelling(Arranged(), BallFigures(400, 41), 1, 0);
  return model;
}

struct Labels {
  std::vector<uint8_t> first, second, truth;
};

Labels LabelsOf(const ForestModel& model, const TrainingImage& image) {
  const Classification result = ClassifyImage(model, image);
  const auto proposals = Propose(model, test::MakeView(image), image.camera, result);
  Labels labels{
      result.label, Relabel(model, test::MakeView(image), image.camera, result, proposals), {}};
  for (const int32_t p : result.pixel) labels.truth.push_back(image.label[static_cast<size_t>(p)]);
  return labels;
}

TEST(Relabel, IsMoreAccurateThanTheTreesAlone) {
  const BallFigures unseen(60, 77);
  int64_t first_wrong = 0;
  int64_t second_wrong = 0;
  for (size_t i = 0; i < unseen.size(); ++i) {
    const Labels labels = LabelsOf(WithPrior(), unseen.Read(i));
    for (size_t p = 0; p < labels.truth.size(); ++p) {
      first_wrong += labels.first[p] != labels.truth[p] ? 1 : 0;
      second_wrong += labels.second[p] != labels.truth[p] ? 1 : 0;
    }
  }
  EXPECT_LT(second_wrong, first_wrong);
}

TEST(Relabel, KeepsLabelsWithoutARelabelling) {
  const Labels labels = LabelsOf(Arranged(), BallFigures(4, 1).Read(2));
  EXPECT_EQ(labels.first, labels.second);
}

TEST(Relabel, FollowsConfidentWeights) {
  ForestData data = WithPrior().data();
  data.relabelling.weight.assign(data.relabelling.weight.size(), 0.0F);
  data.relabelling.bias.assign(data.relabelling.bias.size(), 0.0F);
  data.relabelling.bias[3] = 100.0F;  // e^100: more than any leaf can say against it
  const ForestModel model{std::move(data)};
  const Labels labels = LabelsOf(model, BallFigures(4, 1).Read(2));
  EXPECT_EQ(labels.second, std::vector<uint8_t>(labels.second.size(), 4));
}

TEST(Relabel, GivesNothingForNoPixels) {
  const TrainingImage image = BallFigures(1, 1).Read(0);
  EXPECT_TRUE(
      Relabel(WithPrior(), test::MakeView(image), image.camera, Classification(), {{}, {}, {}})
          .empty());
}

TEST(RadialBasis, IsBitIdenticalOnEveryInstructionSet) {
  std::vector<std::vector<Proposal>> proposals(11);
  for (size_t t = 1; t < proposals.size(); ++t) {
    const double d = 0.1 * static_cast<double>(t);
    proposals[t] = {{{d, 0.3 - d, 2.0 + d * d}, 0.5, true}};
  }
  const Anchors anchors(proposals);
  const Eigen::Vector3f point_m(0.21F, -0.33F, 2.17F);
  const RowMatrix near = ComputeRadialBasis(anchors, {point_m});
  for (size_t t = 0; t < proposals.size(); ++t) {
    // volatile: the compiler may neither reorder nor fuse
    const volatile float x = point_m.x() - anchors.x[t];
    const volatile float y = point_m.y() - anchors.y[t];
    const volatile float z = point_m.z() - anchors.z[t];
    const volatile float xx = x * x, yy = y * y, zz = z * z;
    const volatile float xy = xx + yy;
    const volatile float square = xy + zz;
    const volatile float scaled = square * (1.0F / (0.4F * 0.4F));
    const volatile float slow = 1.0F / (1.0F + scaled);
    EXPECT_EQ(near(0, static_cast<Eigen::Index>(t)), slow) << "target " << t;
  }
  EXPECT_LT(near(0, 0), 1e-6F) << "what was not proposed is near nothing";
}

TEST(LearnRelabelling, GivesTheSameBytesForAnyNumberOfThreads) {
  const BallFigures figures(80, 21);
  EXPECT_EQ(test::ToBytes(LearnRelabelling(Arranged(), figures, 1, 1)),
            test::ToBytes(LearnRelabelling(Arranged(), figures, 1, 3)));
}

TEST(LearnRelabelling, RefusesImagesWithoutObjects) {
  EXPECT_THROW(LearnRelabelling(Arranged(), BallFigures(0, 1), 1, 1), InputError);
}

// Such labels would index beyond the classes.
TEST(LearnRelabelling, RefusesLabelsThatTheModelLacks) {
  const test::ChangedFigures others([](TrainingImage& image) {
    for (uint8_t& label : image.label) label = label == 1 ? 200 : label;
  });
  EXPECT_THROW(LearnRelabelling(Arranged(), others, 1, 1), InputError);
}

TEST(ForestModelFile, RoundTripKeepsTheRelabelling) {
  const std::vector<char> bytes = test::ToBytes(WithPrior());
  const ForestModel read = ReadForestModel(std::as_bytes(std::span(bytes)), "body.ossa");
  EXPECT_EQ(read.data().relabelling.weight, WithPrior().data().relabelling.weight);
  EXPECT_EQ(read.data().relabelling.bias, WithPrior().data().relabelling.bias);
}

TEST(ForestModel, RefusesARelabellingThatDoesNotFit) {
  const auto refused = [](const auto& damage) {
    ForestData data = WithPrior().data();
    damage(&data.relabelling);
    EXPECT_THROW(ForestModel(std::move(data), "body.ossa"), InputError);
  };
  refused([](Relabelling* prior) { prior->weight.pop_back(); });
  refused([](Relabelling* prior) { prior->bias.clear(); });
  refused([](Relabelling* prior) { prior->weight[3] = std::nanf(""); });
  refused([](Relabelling* prior) { prior->bias[1] = 1e9F; });
}

}  // namespace
}  // namespace ossa::forest
