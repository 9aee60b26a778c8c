#include "tools/learning/learn_prior_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "forest/training/train.h"
#include "recon/models/prior_filter.h"

namespace ossa::tools {
namespace {

using recon::Joint;
using recon::kJointCount;
using recon::Posture;

constexpr double kFrame_s = 1.0 / 30.0;

void TurnAboutX(Posture& posture, std::initializer_list<Joint> moved, Joint about, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).matrix();
  const Eigen::Vector3d pivot = posture[about];
  for (const Joint joint : moved) posture[joint] = pivot + turn * (posture[joint] - pivot);
}

/// A person with raised arms who leans forwards and backwards, with knees bent only when upright: a
/// dependency that mean and covariance of the trunk do not contain.
Posture Leaning(double lean_rad) {
  Posture posture = recon::StandardStance();
  TurnAboutX(posture, {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft},
             Joint::kShoulderLeft, std::numbers::pi);
  TurnAboutX(posture, {Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight},
             Joint::kShoulderRight, std::numbers::pi);
  TurnAboutX(posture,
             {Joint::kSpine, Joint::kShoulderCenter, Joint::kHead, Joint::kShoulderLeft,
              Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft, Joint::kShoulderRight,
              Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight},
             Joint::kHipCenter, lean_rad);
  const double bend_rad = 1.5 * std::exp(-50.0 * lean_rad * lean_rad);
  TurnAboutX(posture, {Joint::kAnkleLeft, Joint::kFootLeft}, Joint::kKneeLeft, bend_rad);
  TurnAboutX(posture, {Joint::kAnkleRight, Joint::kFootRight}, Joint::kKneeRight, bend_rad);
  return posture;
}

std::vector<recon::PriorClip> Leans(double seconds) {
  recon::PriorClip clip;
  for (double t = 0.0; t < seconds; t += kFrame_s) {
    clip.postures.push_back(Leaning(0.6 * std::sin(2.0 * std::numbers::pi * 0.2 * t)));
  }
  return {clip};
}

PriorNetworkOptions Small() {
  PriorNetworkOptions options;
  options.hidden = 32;
  options.epochs = 8;
  return options;
}

/// Mean error of the ankles, metres, of leans of which only the hands are observed.
double AnkleError_m(const recon::PosturePrior& prior) {
  recon::PriorFilter filter(std::make_shared<recon::PosturePrior>(prior));
  double sum_m = 0.0;
  constexpr int kFrames = 150;
  for (int i = 0; i < kFrames; ++i) {
    const Posture truth =
        Normalised(Leaning(0.6 * std::sin(2.0 * std::numbers::pi * 0.2 * i * kFrame_s)),
                   {recon::StandardStance().position_m[0], 0.0});
    recon::PriorObservation observation;
    observation.seen = truth;
    observation.sd_m[Joint::kHandLeft] = recon::BaseSigma_m(0.0);
    observation.sd_m[Joint::kHandRight] = recon::BaseSigma_m(0.0);
    observation.root_sd_m = 0.02;
    observation.lengths_m = recon::StandardBoneLengths();
    const Posture got = filter.Step(kFrame_s, observation);
    sum_m += (got[Joint::kAnkleLeft] - truth[Joint::kAnkleLeft]).norm();
  }
  return sum_m / kFrames;
}

TEST(LearnPriorNetwork, LearnsADependencyThatNoGaussianHas) {
  const auto clips = Leans(60.0);
  recon::PosturePrior prior = recon::PosturePrior::Learn(clips);
  const double gaussian_m = AnkleError_m(prior);
  PriorNetworkOptions options = Small();
  options.epochs = 60;
  prior.network = LearnPriorNetwork(prior, clips, options);
  EXPECT_GT(gaussian_m, 0.08);
  EXPECT_LT(AnkleError_m(prior), 0.8 * gaussian_m);
}

TEST(LearnPriorNetwork, IsTheSameForAnyNumberOfThreads) {
  const auto clips = Leans(20.0);
  const recon::PosturePrior prior = recon::PosturePrior::Learn(clips);
  PriorNetworkOptions one = Small(), three = Small();
  one.threads = 1;
  three.threads = 3;
  one.epochs = three.epochs = 1;
  const auto a = LearnPriorNetwork(prior, clips, one), b = LearnPriorNetwork(prior, clips, three);
  EXPECT_TRUE(a.layers[0].weight == b.layers[0].weight);
  EXPECT_TRUE(a.layers[1].weight == b.layers[1].weight);
  EXPECT_TRUE(a.input_mean == b.input_mean && a.input_scale == b.input_scale);
  one.seed = 2;
  EXPECT_FALSE(LearnPriorNetwork(prior, clips, one).layers[0].weight == a.layers[0].weight);
}

TEST(LearnPriorNetwork, RefusesNoMotionAndCanBeInterrupted) {
  const recon::PosturePrior prior = recon::PosturePrior::Learn(Leans(20.0));
  EXPECT_THROW(LearnPriorNetwork(prior, Leans(0.1), Small()), InputError);
  PriorNetworkOptions stopped = Small();
  stopped.stop = [] { return true; };
  EXPECT_THROW(LearnPriorNetwork(prior, Leans(20.0), stopped), TrainInterrupted);
}

}  // namespace
}  // namespace ossa::tools
