#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "depth/base/error.h"
#include "forest/proposals/pose_inference_internal.h"
#include "forest/training/train.h"
#include "tests/forest/ball_figure.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

// The ball model with three targets a metre above each other, with a standard deviation of 2 cm;
// `trust` is the prior trust in every mode, whatever its features.
ForestModel Column(double trust) {
  ForestData data = BallModel().data();
  for (ProposalTarget& target : data.targets) {
    target.correct = ModeConfidence();
    target.correct.bias = static_cast<float>(std::log(trust / (1.0 - trust)));
  }
  PosePrior column;
  column.mean_m = {0, -1, 0, 0, 0, 0, 0, 1, 0};
  column.loading_m.assign(9, 0.0F);
  column.noise_m.assign(3, 0.02F);
  data.pose_priors.assign(data.context_names.size(), column);
  return ForestModel(std::move(data));
}

Mode ModeAt(float x, float y, float z) {
  Mode mode;
  mode.position_m = {x, y, z};
  return mode;
}

TEST(PoseInference, PredictsATargetWithoutModesFromTheOthers) {
  const std::vector<float> posterior = {0.5F, 0.5F};
  const TargetModes modes = {{ModeAt(1, 0, 3)}, {ModeAt(1, 1, 3)}, {}};
  const PoseMarginals marginals = InferPose(Column(0.9), posterior, modes);
  // The two modes fit exactly; the free place (2 m about their centre) pulls by (2 cm / 2 m)².
  EXPECT_NEAR((marginals.target[2].predicted_m - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-3);
  EXPECT_NEAR((Fuse(marginals.target[2], {}, 0.03) - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-3);
}

TEST(PoseInference, PrefersTheModeThatFitsTheOtherTargets) {
  const std::vector<float> posterior = {0.5F, 0.5F};
  const TargetModes modes = {
      {ModeAt(1, 0, 3)}, {ModeAt(1, 1, 3)}, {ModeAt(2, 0, 3), ModeAt(1, 2, 3)}};
  const PoseMarginals marginals = InferPose(Column(0.45), posterior, modes);
  EXPECT_LT(marginals.target[2].weight[0], 0.01);
  EXPECT_GT(marginals.target[2].weight[1], 0.9);
}

TEST(PoseInference, DistantModesStayCandidates) {
  const std::vector<float> posterior = {0.5F, 0.5F};
  const TargetModes modes = {
      {ModeAt(1, 0, 3)}, {ModeAt(1, 1, 3)}, {ModeAt(2, 0, 3), ModeAt(1, 2, 3)}};
  const ForestModel model = Column(0.45);
  const PoseMarginals marginals = InferPose(model, posterior, modes);
  const auto candidates = Candidates(model.targets()[2], marginals, 2, modes[2]);
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_TRUE(candidates[0].is_fused);
  EXPECT_EQ(candidates[0].mode, 1);
  EXPECT_FALSE(candidates[1].is_fused);
  EXPECT_EQ(candidates[1].mode, 0);
}

TEST(LearnPosePriors, LearnsRelativePositions) {
  const BallFigures figures(400, 9);
  const ForestModel model = LearnPosePriors(BallModel(), figures, 400, 1);
  ASSERT_EQ(model.data().pose_priors.size(), 2U);
  for (size_t context = 0; context < 2; ++context) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  // of the head, about the middle of all three
    float count = 0;
    for (size_t i = 0; i < figures.size(); ++i) {
      const TrainingImage image = figures.Read(i);
      if (image.context != context) continue;
      mean += image.target_m[0] - (image.target_m[0] + image.target_m[1] + image.target_m[2]) / 3;
      count += 1;
    }
    const float* learned = model.data().pose_priors[context].mean_m.data();
    // Five borrowed images of some 200 may pull by 5 / 205 of the contexts' difference.
    EXPECT_LT((Eigen::Vector3f(learned[0], learned[1], learned[2]) - mean / count).norm(), 0.02F);
  }
}

TEST(LearnPosePriors, KeepsTheModelIfThereAreTooFewImages) {
  EXPECT_TRUE(LearnPosePriors(BallModel(), BallFigures(4, 9), 4, 1).data().pose_priors.empty());
}

TEST(ForestModel, RefusesPosePriorsThatDoNotFitItsTargets) {
  ForestData data = Column(0.5).data();
  data.pose_priors[1].noise_m.pop_back();
  EXPECT_THROW(ForestModel(std::move(data), "body.ossa"), InputError);
  data = Column(0.5).data();
  data.pose_priors.pop_back();
  EXPECT_THROW(ForestModel(std::move(data), "body.ossa"), InputError);
  data = Column(0.5).data();
  data.pose_priors[0].noise_m[0] = 0.0F;
  EXPECT_THROW(ForestModel(std::move(data), "body.ossa"), InputError);
}

TEST(ForestModelFile, RoundTripKeepsThePosePriors) {
  const std::vector<char> bytes = test::ToBytes(Column(0.5));
  const ForestModel read = ReadForestModel(std::as_bytes(std::span(bytes)), "body.ossa");
  EXPECT_EQ(test::ToBytes(read), bytes);
  EXPECT_EQ(read.data().pose_priors.size(), 2U);
}

// Five targets (no multiple of what a processor does side by side) and two factors.
PosePrior SomePosePrior() {
  PosePrior prior;
  for (int i = 0; i < 15; ++i) {
    prior.mean_m.push_back(0.1F * static_cast<float>(i % 4));
    prior.loading_m.push_back(0.1F * std::sin(static_cast<float>(3 * i)));
    prior.loading_m.push_back(0.2F * std::cos(static_cast<float>(5 * i)));
  }
  prior.noise_m = {0.02F, 0.03F, 0.04F, 0.05F, 0.06F};
  return prior;
}

// The joint normal distribution of all coordinates, conditioned on the sites of all targets but
// `t`.
Prediction PredictByConditioning(const PosePrior& prior, const std::vector<Site>& sites, size_t t) {
  Eigen::MatrixXd loading(15, 5);
  for (int i = 0; i < 15; ++i) {
    for (int f = 0; f < 2; ++f) loading(i, f) = prior.loading_m[static_cast<size_t>(2 * i + f)];
    for (int axis = 0; axis < 3; ++axis) loading(i, 2 + axis) = i % 3 == axis ? 2.0 : 0.0;
  }
  Eigen::MatrixXd covariance = loading * loading.transpose();
  Eigen::VectorXd off = Eigen::VectorXd::Zero(15);
  std::vector<Eigen::Index> given;
  for (size_t s = 0; s < sites.size(); ++s) {
    if (s == t || sites[s].variance_m2 <= 0) continue;
    for (Eigen::Index i = 3 * static_cast<Eigen::Index>(s), axis = 0; axis < 3; ++i, ++axis) {
      given.push_back(i);
      covariance(i, i) += sites[s].variance_m2;
      off[i] = sites[s].mean_m[axis] - prior.mean_m[static_cast<size_t>(i)];
    }
  }
  const auto own = Eigen::seqN(3 * static_cast<Eigen::Index>(t), 3);
  const Eigen::MatrixXd gain = covariance(own, given) * covariance(given, given).inverse();
  Prediction prediction;
  const float* mean_m = prior.mean_m.data() + 3 * t;
  prediction.predicted_m = Eigen::Vector3d(mean_m[0], mean_m[1], mean_m[2]) + gain * off(given);
  const double noise_m = prior.noise_m[t];
  prediction.covariance_m2 = covariance(own, own) - gain * covariance(given, own) +
                             noise_m * noise_m * Eigen::Matrix3d::Identity();
  return prediction;
}

TEST(FactorModel, PredictionEqualsGaussianConditioning) {
  const std::vector<Site> sites = {{1e-3, {0.1, 0.2, 2.0}},
                                   {4e-3, {0.3, 0.1, 2.1}},
                                   {},
                                   {2e-3, {0.2, 0.0, 1.9}},
                                   {9e-3, {0.0, 0.4, 2.0}}};
  const std::vector<Prediction> predictions = FactorModel(SomePosePrior()).Predict(sites);
  ASSERT_EQ(predictions.size(), sites.size());
  for (size_t t = 0; t < sites.size(); ++t) {
    const Prediction expected = PredictByConditioning(SomePosePrior(), sites, t);
    // Both lose digits where a place that is free by metres is told to centimetres.
    EXPECT_LT((predictions[t].predicted_m - expected.predicted_m).norm(), 1e-9) << t;
    EXPECT_LT((predictions[t].covariance_m2 - expected.covariance_m2).norm(), 1e-9) << t;
  }
}

}  // namespace
}  // namespace ossa::forest
