#include "forest/proposals/refinement_internal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "depth/base/error.h"
#include "forest/joint_features_internal.h"
#include "forest/training/train.h"
#include "forest/training/validation_internal.h"
#include "tests/forest/ball_figure.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

RowMatrix Filled(Eigen::Index rows, Eigen::Index columns, float first) {
  RowMatrix m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    m.data()[i] = std::sin(first + 0.7F * static_cast<float>(i));
  }
  return m;
}

class ProductOfSizes : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(ProductOfSizes, IsTheSumInItsOrderBitByBit) {
  const auto [rows, inner, columns] = GetParam();
  const RowMatrix a = Filled(rows, inner, 0.1F);
  const RowMatrix b = Filled(inner, columns, 2.0F);
  const RowMatrix product = Product(a, b);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      volatile float sum = 0.0F;  // volatile: the compiler may not sum in another order
      for (int k = 0; k < inner; ++k) {
        const volatile float term = a(r, k) * b(k, c);
        sum = sum + term;
      }
      EXPECT_EQ(product(r, c), sum) << r << ", " << c;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Dense, ProductOfSizes,
                         testing::Values(std::array{1, 1, 1}, std::array{1, 40, 16},
                                         std::array{4, 7, 32}, std::array{5, 3, 37},
                                         std::array{9, 64, 15}, std::array{13, 600, 37},
                                         std::array{6, 256, 16}, std::array{8, 0, 20}));

// The ball model with proposals and arrangements learned.
const ForestModel& Arranged() {
  static const ForestModel model = LearnProposals(
      LearnArrangements(BallModel(), BallFigures(300, 9), 300, 0), BallFigures(100, 5), 100, 0);
  return model;
}

Description DescribeFigure(const TrainingImage& image) {
  const ValidationImage gathered = GatherImage(Arranged(), image);
  const Heard heard = Hear(Arranged(), gathered);
  return Describe(Arranged(), image.camera, gathered.evidence, gathered.context, heard.modes,
                  heard.beliefs);
}

// Layers that say the same of every object: an offset of each target, and a logit.
Refinement Constant(const Eigen::Vector3f& steps, float logit) {
  const size_t inputs = DescriptionSize(3, 6, 2);
  Refinement refinement;
  refinement.input_mean.assign(inputs, 0.0F);
  refinement.input_scale.assign(inputs, 1.0F);
  NetworkLayer layer;
  layer.weight.assign(inputs * 12, 0.0F);
  for (int t = 0; t < 3; ++t) {
    layer.bias.insert(layer.bias.end(), steps.data(), steps.data() + 3);
  }
  layer.bias.insert(layer.bias.end(), 3, logit);
  refinement.layers = {layer};
  return refinement;
}

TEST(Describe, SaysAsManyNumbersAsItPromises) {
  const Description description = DescribeFigure(BallFigures(4, 1).Read(1));
  EXPECT_EQ(description.value.size(), DescriptionSize(3, 6, 2));
  for (const float value : description.value) EXPECT_TRUE(std::isfinite(value));
}

TEST(Refine, MovesPlacesInAxesAlongTheSight) {
  const Description description = DescribeFigure(BallFigures(4, 1).Read(1));
  const auto places = Refine(Constant({0.0F, 0.0F, 1.0F}, 0.0F), description);
  const Eigen::Vector3d away = kRefinementStep_m * description.root_m.normalized();
  for (size_t t = 0; t < places.size(); ++t) {
    // Floats of about 3 m in, so micrometres out.
    EXPECT_NEAR((places[t].position_m - description.place_m[t] - away).norm(), 0.0, 1e-6);
    EXPECT_DOUBLE_EQ(places[t].confidence, 0.5);
  }
}

TEST(Propose, GivesTheRefinedPlaceItsConfidence) {
  ForestData data = Arranged().data();
  data.refinement = Constant({0.5F, 0.0F, 0.0F}, std::log(3.0F));
  const ForestModel model{std::move(data)};
  const TrainingImage image = BallFigures(4, 1).Read(1);
  const Description description = DescribeFigure(image);
  const auto proposals =
      Propose(model, test::ViewOf(image), image.camera, ClassifyImage(model, image));
  for (size_t t = 0; t < proposals.size(); ++t) {
    const bool found =
        std::any_of(proposals[t].begin(), proposals[t].end(), [&](const Proposal& proposal) {
          const double moved_m = (proposal.position_m - description.place_m[t]).norm();
          return std::abs(moved_m - 0.05) < 1e-6 && std::abs(proposal.confidence - 0.75) < 1e-6;
        });
    EXPECT_TRUE(found) << "target " << t;
  }
}

RefinementOptions Quick(int threads) {
  RefinementOptions options;
  options.hidden = 16;
  options.epochs = 20;
  options.threads = threads;
  return options;
}

// Root mean square distance of the best proposals to the truth.
double Error_m(const ForestModel& model) {
  const BallFigures unseen(60, 66);
  double sum = 0;
  for (size_t i = 0; i < unseen.size(); ++i) {
    const TrainingImage image = unseen.Read(i);
    const auto proposals =
        Propose(model, test::ViewOf(image), image.camera, ClassifyImage(model, image));
    for (size_t t = 0; t < proposals.size(); ++t) {
      sum += (proposals[t].at(0).position_m.cast<float>() - image.target_m[t]).squaredNorm();
    }
  }
  return std::sqrt(sum / static_cast<double>(3 * unseen.size()));
}

TEST(LearnRefinement, BringsPlacesNearerToTheTruth) {
  const ForestModel refined = LearnRefinement(Arranged(), BallFigures(600, 21), Quick(0));
  EXPECT_LT(Error_m(refined), 0.9 * Error_m(Arranged()));
}

TEST(LearnRefinement, GivesTheSameBytesForAnyNumberOfThreads) {
  const BallFigures figures(200, 21);
  EXPECT_EQ(test::BytesOf(LearnRefinement(Arranged(), figures, Quick(1))),
            test::BytesOf(LearnRefinement(Arranged(), figures, Quick(3))));
}

TEST(LearnRefinement, RefusesTooFewImagesAndAModelWithoutArrangements) {
  EXPECT_THROW(LearnRefinement(Arranged(), BallFigures(20, 21), Quick(1)), InputError);
  EXPECT_THROW(LearnRefinement(BallModel(), BallFigures(200, 21), Quick(1)), InputError);
}

TEST(LearnRefinement, StopsWhenTold) {
  RefinementOptions options = Quick(1);
  options.stop = [] { return true; };
  EXPECT_THROW(LearnRefinement(Arranged(), BallFigures(200, 21), options), TrainInterrupted);
}

TEST(ForestModelFile, ARefinementComesBackAsItWas) {
  ForestData data = Arranged().data();
  data.refinement = Constant({0.5F, 0.25F, 0.0F}, 1.0F);
  const ForestModel model{std::move(data)};
  const std::vector<char> bytes = test::BytesOf(model);
  const ForestModel read = ReadForestModel(std::as_bytes(std::span(bytes)), "body.ossa");
  EXPECT_EQ(test::BytesOf(read), bytes);
  EXPECT_EQ(read.data().refinement.layers.at(0).bias, model.data().refinement.layers.at(0).bias);
}

TEST(ForestModel, RefusesARefinementThatDoesNotFit) {
  const auto refused = [](const auto& damage) {
    ForestData data = Arranged().data();
    data.refinement = Constant({0.0F, 0.0F, 0.0F}, 0.0F);
    damage(&data);
    EXPECT_THROW(ForestModel(std::move(data), "body.ossa"), InputError);
  };
  refused([](ForestData* d) { d->refinement.input_mean.pop_back(); });
  refused([](ForestData* d) { d->refinement.layers[0].weight.pop_back(); });
  refused([](ForestData* d) { d->refinement.layers[0].weight[5] = std::nanf(""); });
  refused([](ForestData* d) { d->refinement.layers.resize(9, d->refinement.layers[0]); });
  refused([](ForestData* d) { d->refinement.layers.push_back({{}, {}}); });
  refused([](ForestData* d) { d->arrangements.clear(); });
}

}  // namespace
}  // namespace ossa::forest
