#include "forest/proposals/refinement_internal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "forest/joint_features_internal.h"
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

JointFeatures ComputeFigureFeatures(const TrainingImage& image) {
  const ValidationImage gathered = GatherImage(Arranged(), image);
  const FirstStage first = RunFirstStage(Arranged(), gathered);
  return ComputeJointFeatures(Arranged(), image.camera, gathered.evidence, gathered.context,
                              first.modes, first.marginals);
}

// Layers with constant output: an offset of each target, and a logit.
Perceptron Constant(const Eigen::Vector3f& steps, float logit) {
  const auto inputs = static_cast<Eigen::Index>(JointFeatureCount(3, 6, 2));
  Perceptron refinement;
  refinement.input_mean.setZero(inputs);
  refinement.input_scale.setOnes(inputs);
  refinement.layers = {{RowMatrix::Zero(inputs, 12), Eigen::RowVectorXf(12)}};
  refinement.layers[0].bias << steps.transpose(), steps.transpose(), steps.transpose(), logit,
      logit, logit;
  return refinement;
}

TEST(JointFeatures, HasTheDocumentedSize) {
  const JointFeatures features = ComputeFigureFeatures(BallFigures(4, 1).Read(1));
  EXPECT_EQ(static_cast<size_t>(features.value.size()), JointFeatureCount(3, 6, 2));
  for (const float value : features.value) EXPECT_TRUE(std::isfinite(value));
}

TEST(Refine, MovesPositionsInAxesAlongTheRay) {
  const JointFeatures features = ComputeFigureFeatures(BallFigures(4, 1).Read(1));
  const auto places = Refine(RoundedPerceptron(Constant({0.0F, 0.0F, 1.0F}, 0.0F)), features);
  const Eigen::Vector3d away = OffsetScale().step_m * features.frame.middle_m.normalized();
  for (size_t t = 0; t < places.size(); ++t) {
    // Floats of about 3 m in, so micrometres out.
    EXPECT_NEAR((places[t].position_m - features.place_m[t] - away).norm(), 0.0, 1e-6);
    EXPECT_DOUBLE_EQ(places[t].confidence, 0.5);
  }
}

TEST(Propose, RefinedPositionHasItsConfidence) {
  ForestData data = Arranged().data();
  data.refinement = Constant({0.5F, 0.0F, 0.0F}, std::log(3.0F));
  const ForestModel model{std::move(data)};
  const TrainingImage image = BallFigures(4, 1).Read(1);
  const JointFeatures features = ComputeFigureFeatures(image);
  const auto proposals =
      Propose(model, test::MakeView(image), image.camera, ClassifyImage(model, image));
  for (size_t t = 0; t < proposals.size(); ++t) {
    const bool found =
        std::any_of(proposals[t].begin(), proposals[t].end(), [&](const Proposal& proposal) {
          const double moved_m = (proposal.position_m - features.place_m[t]).norm();
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
        Propose(model, test::MakeView(image), image.camera, ClassifyImage(model, image));
    for (size_t t = 0; t < proposals.size(); ++t) {
      sum += (proposals[t].at(0).position_m.cast<float>() - image.target_m[t]).squaredNorm();
    }
  }
  return std::sqrt(sum / static_cast<double>(3 * unseen.size()));
}

TEST(LearnRefinement, ReducesTheErrorOfPositions) {
  const ForestModel refined = LearnRefinement(Arranged(), BallFigures(600, 21), Quick(0));
  EXPECT_LT(Error_m(refined), 0.9 * Error_m(Arranged()));
}

TEST(LearnRefinement, GivesTheSameBytesForAnyNumberOfThreads) {
  const BallFigures figures(200, 21);
  EXPECT_EQ(test::ToBytes(LearnRefinement(Arranged(), figures, Quick(1))),
            test::ToBytes(LearnRefinement(Arranged(), figures, Quick(3))));
}

TEST(LearnRefinement, RefusesTooFewImagesAndAModelWithoutPosePriors) {
  EXPECT_THROW(LearnRefinement(Arranged(), BallFigures(20, 21), Quick(1)), InputError);
  EXPECT_THROW(LearnRefinement(BallModel(), BallFigures(200, 21), Quick(1)), InputError);
}

TEST(LearnRefinement, StopsOnRequest) {
  RefinementOptions options = Quick(1);
  options.stop = [] { return true; };
  EXPECT_THROW(LearnRefinement(Arranged(), BallFigures(200, 21), options), TrainInterrupted);
}

TEST(ForestModelFile, RoundTripKeepsTheRefinement) {
  ForestData data = Arranged().data();
  data.refinement = Constant({0.5F, 0.25F, 0.0F}, 1.0F);
  const ForestModel model{std::move(data)};
  const std::vector<char> bytes = test::ToBytes(model);
  const ForestModel read = ReadForestModel(std::as_bytes(std::span(bytes)), "body.ossa");
  EXPECT_EQ(test::ToBytes(read), bytes);
  EXPECT_EQ(read.data().refinement.layers.at(0).bias, model.data().refinement.layers.at(0).bias);
}

TEST(ForestModel, RefusesARefinementThatDoesNotFit) {
  const auto refused = [](const auto& damage) {
    ForestData data = Arranged().data();
    data.refinement = Constant({0.0F, 0.0F, 0.0F}, 0.0F);
    damage(&data);
    EXPECT_THROW(ForestModel(std::move(data), "body.ossa"), InputError);
  };
  refused([](ForestData* d) { d->refinement.input_mean.conservativeResize(3); });
  refused([](ForestData* d) {
    d->refinement.layers[0].weight.conservativeResize(Eigen::NoChange, 11);
  });
  refused([](ForestData* d) { d->refinement.layers[0].weight(0, 5) = std::nanf(""); });
  refused([](ForestData* d) { d->refinement.layers.resize(9, d->refinement.layers[0]); });
  refused([](ForestData* d) { d->refinement.layers.emplace_back(); });
  refused([](ForestData* d) { d->pose_priors.clear(); });
}

}  // namespace
}  // namespace ossa::forest
