#include "recon/models/gaussian_process.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "recon/models/local_mixture.h"

namespace ossa::recon {
namespace {

struct Samples {
  Eigen::MatrixXd x, y;
};

/// A smooth function of two numbers, three outputs.
Samples MakeSamples(int count, double noise_m = 0.0) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::normal_distribution<double> normal(0.0, 1.0);
  Samples s{Eigen::MatrixXd(count, 2), Eigen::MatrixXd(count, 3)};
  for (int i = 0; i < count; ++i) {
    s.x.row(i) << uniform(rng), uniform(rng);
    s.y.row(i) << 0.05 * std::sin(4.0 * s.x(i, 0)), 0.03 * s.x(i, 1), 0.02;
    for (int c = 0; c < 3; ++c) s.y(i, c) += noise_m * normal(rng);
  }
  return s;
}

TEST(GaussianProcess, EqualsTheFormulaWithAnExplicitInverse) {
  const Samples s = MakeSamples(20);
  const GaussianProcessParameters p;
  const GaussianProcess process(p, s.x, s.y);
  const Eigen::VectorXd at = Eigen::Vector2d(0.1, -0.2);
  Eigen::VectorXd k(20);
  for (int i = 0; i < 20; ++i) {
    k[i] = p.theta0 * std::exp(-0.5 * p.w * (s.x.row(i).transpose() - at).squaredNorm()) + p.theta1;
  }
  const Eigen::MatrixXd inverse = KernelMatrix(p, s.x).inverse();
  const Eigen::Vector3d mean = s.y.transpose() * (inverse * k);      // eq. 8
  const double variance = p.theta0 + p.theta1 - k.dot(inverse * k);  // eq. 9
  const GaussianPrediction made = process.Predict(at);
  // Condition number of K about 1e3: twelve digits stay.
  EXPECT_LT((made.mean - mean).norm(), 1e-10);
  EXPECT_NEAR(made.variance, variance, 1e-10);
}

TEST(GaussianProcess, IncrementalLearningEqualsBatchLearning) {
  const Samples s = MakeSamples(30);
  GaussianProcess grown({}, s.x.topRows(10), s.y.topRows(10));
  for (int i = 10; i < 30; ++i) grown.Add(s.x.row(i).transpose(), s.y.row(i).transpose());
  const GaussianProcess whole({}, s.x, s.y);
  EXPECT_LT((grown.factor() - whole.factor()).cwiseAbs().maxCoeff(), 1e-12);  // eqs. 14-17
  const Eigen::VectorXd at = Eigen::Vector2d(0.3, 0.3);
  EXPECT_LT((grown.Predict(at).mean - whole.Predict(at).mean).norm(), 1e-10);
}

TEST(NegativeLogLikelihood, HasItsGradient) {
  const Samples s = MakeSamples(15, 0.01);
  const GaussianProcessParameters p{2e-3, 5e-4, 30.0, 5e3};
  double gradient[4];
  NegativeLogLikelihood(p, s.x, s.y, gradient);
  constexpr double kStep = 1e-5;  // of the logarithms
  for (int i = 0; i < 4; ++i) {
    GaussianProcessParameters plus = p, minus = p;
    double* const up[] = {&plus.theta0, &plus.theta1, &plus.w, &plus.beta};
    double* const down[] = {&minus.theta0, &minus.theta1, &minus.w, &minus.beta};
    *up[i] *= std::exp(kStep);
    *down[i] *= std::exp(-kStep);
    const double numeric = (NegativeLogLikelihood(plus, s.x, s.y, nullptr) -
                            NegativeLogLikelihood(minus, s.x, s.y, nullptr)) /
                           (2.0 * kStep);
    // Central differences lose half the digits of a value of a few hundred.
    EXPECT_NEAR(gradient[i], numeric, 1e-4 * (1.0 + std::abs(numeric))) << i;
  }
}

TEST(LearnParameters, NeverLowersTheLikelihoodAndFindsTheNoise) {
  const Samples s = MakeSamples(120, 0.01);
  const GaussianProcessParameters start;
  const auto learned = LearnParameters(s.x, s.y, start);
  EXPECT_LE(NegativeLogLikelihood(learned, s.x, s.y, nullptr),
            NegativeLogLikelihood(start, s.x, s.y, nullptr));
  // 360 noisy numbers tell their standard deviation to about 4 %; flat likelihood: 20 %.
  EXPECT_NEAR(1.0 / std::sqrt(learned.beta), 0.01, 0.002);
}

/// Prediction of a process at one of its own places, as a normal distribution.
double KlWithout(const GaussianProcessParameters& p, const Samples& s, Eigen::Index t) {
  const Eigen::Index n = s.x.rows();
  Eigen::MatrixXd x(n - 1, s.x.cols()), y(n - 1, 3);
  x << s.x.topRows(t), s.x.bottomRows(n - 1 - t);
  y << s.y.topRows(t), s.y.bottomRows(n - 1 - t);
  const auto with = GaussianProcess(p, s.x, s.y).Predict(s.x.row(t).transpose());
  const auto without = GaussianProcess(p, x, y).Predict(s.x.row(t).transpose());
  const double a = with.variance + 1.0 / p.beta, b = without.variance + 1.0 / p.beta;
  return 1.5 * (std::log(b / a) + a / b - 1.0) +
         0.5 * (with.mean - without.mean).squaredNorm() / b;  // eqs. 1-2, three outputs
}

TEST(BudgetedSamples, DropTheSampleWithTheLeastKlDivergenceFirst) {
  const Samples s = MakeSamples(12, 0.01);
  const GaussianProcessParameters p;
  Eigen::Index least = 0;
  for (Eigen::Index t = 1; t < 12; ++t) {
    if (KlWithout(p, s, t) < KlWithout(p, s, least)) least = t;
  }
  const auto kept = BudgetedSamples(p, s.x, s.y, 11);
  ASSERT_EQ(kept.size(), 11u);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), static_cast<int>(least)), 0);
}

/// The rows left after removing, again and again, the one of least divergence.
std::vector<int> BudgetedByBruteForce(const GaussianProcessParameters& p, const Samples& s,
                                      size_t keep) {
  std::vector<int> rows(static_cast<size_t>(s.x.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  while (rows.size() > keep) {
    const Samples left{s.x(rows, Eigen::all), s.y(rows, Eigen::all)};
    Eigen::Index least = 0;
    for (Eigen::Index t = 1; t < left.x.rows(); ++t) {
      if (KlWithout(p, left, t) < KlWithout(p, left, least)) least = t;
    }
    rows.erase(rows.begin() + least);
  }
  return rows;
}

TEST(BudgetedSamples, AreThoseOfBruteForce) {
  for (const double noise_m : {0.0, 0.01, 0.05}) {
    const Samples s = MakeSamples(14, noise_m);
    const GaussianProcessParameters p{2e-3, 5e-4, 30.0, 5e3};
    for (const int keep : {10, 5, 1}) {
      EXPECT_EQ(BudgetedSamples(p, s.x, s.y, keep),
                BudgetedByBruteForce(p, s, static_cast<size_t>(keep)))
          << noise_m << " " << keep;
    }
  }
}

// Eqs. 10, 12 and 13 written out, over the L nearest centres. The kernels' own widths differ by a
// factor of a thousand: the widest must not dominate far from its samples.
TEST(LocalMixture, WeighsTheNearestModelsByACommonKernel) {
  const Samples s = MakeSamples(30);
  std::vector<GaussianProcess> models;
  const std::array<double, 3> widths = {0.1, 10.0, 100.0};
  for (int q = 0; q < 3; ++q) {
    GaussianProcessParameters p;
    p.w = widths[static_cast<size_t>(q)];
    Eigen::MatrixXd x = s.x.middleRows(10 * q, 10);
    x.col(0).array() += q;  // regions a metre apart
    models.emplace_back(p, x, s.y.middleRows(10 * q, 10));
  }
  const Eigen::VectorXd at = Eigen::Vector2d(1.6, 0.1);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double variance = 0.0, total = 0.0;
  for (const size_t q : {1U, 2U}) {  // L = 2: the centres at about 1 and 2
    const Eigen::VectorXd centre = models[q].inputs().colwise().mean().transpose();
    const double similarity = std::exp(-0.5 * 10.0 * (at - centre).squaredNorm());
    const GaussianPrediction local = models[q].Predict(at);
    sum += similarity * local.mean;
    variance += similarity * local.variance;
    total += similarity;
  }
  const GaussianPrediction made = LocalMixture(models).Predict(at, 2);
  EXPECT_LT((made.mean - sum / total).norm(), 1e-12);  // rounding
  EXPECT_NEAR(made.variance, variance / total, 1e-12);
}

TEST(LocalMixture, FitsTheFunctionAndAddsModelsForNewRegions) {
  const Samples s = MakeSamples(400);
  LocalMixtureOptions options;
  options.regions = 6;
  options.samples = 30;
  LocalMixture mixture = LocalMixture::Learn(s.x, s.y, options);
  const Eigen::VectorXd at = Eigen::Vector2d(0.2, 0.1);
  EXPECT_NEAR(mixture.Predict(at, 3).mean[0], 0.05 * std::sin(0.8), 0.005);  // a tenth of its range
  const size_t before = mixture.models().size();
  mixture.Update(Eigen::Vector2d(50.0, 50.0), {0.1, 0.2, 0.3}, options);  // algorithm 2
  ASSERT_EQ(mixture.models().size(), before + 1);
  mixture.Update(Eigen::Vector2d(50.0, 50.001), {0.1, 0.2, 0.3}, options);
  EXPECT_EQ(mixture.models().size(), before + 1);
  EXPECT_EQ(mixture.models().back().size(), 2);
}

TEST(KMeans, SeparatesDistantClusters) {
  Eigen::MatrixXd x(30, 2);
  for (int i = 0; i < 30; ++i) x.row(i) << 5.0 * (i % 3) + 0.01 * i, 0.02 * (i % 7);
  const auto region = KMeans(x, 3, 1);
  for (size_t i = 0; i < 30; ++i) EXPECT_EQ(region[i], region[i % 3]) << i;
  EXPECT_NE(region[0], region[1]);
  EXPECT_NE(region[1], region[2]);
  EXPECT_NE(region[0], region[2]);
}

/// One round of Lloyd 1982, by brute force: every row joins the nearest mean of the regions so far.
std::vector<int> NextRound(const Eigen::MatrixXd& x, const std::vector<int>& region, int regions) {
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(regions, x.cols());
  std::vector<int> members(static_cast<size_t>(regions), 0);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    mean.row(region[static_cast<size_t>(i)]) += x.row(i);
    ++members[static_cast<size_t>(region[static_cast<size_t>(i)])];
  }
  for (int c = 0; c < regions; ++c) mean.row(c) /= members[static_cast<size_t>(c)];
  std::vector<int> next;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    Eigen::Index best = 0;
    (mean.rowwise() - x.row(i)).rowwise().squaredNorm().minCoeff(&best);
    next.push_back(static_cast<int>(best));
  }
  return next;
}

// Evenly spread rows: borders still move after dozens of rounds.
TEST(KMeans, RunsFifteenRoundsOfLloydUnlessToldOtherwise) {
  constexpr int kRegions = 7;
  Eigen::MatrixXd x(400, 1);
  for (int i = 0; i < 400; ++i) x(i, 0) = 0.01 * i * i;
  EXPECT_EQ(KMeans(x, kRegions, 3, 0), std::vector<int>(400, 0)) << "no round";
  std::vector<int> region = KMeans(x, kRegions, 3, 1);
  for (int round = 2; round <= 16; ++round) {
    const std::vector<int> next = NextRound(x, region, kRegions);
    ASSERT_NE(next, region) << "settled before round " << round;
    ASSERT_EQ(KMeans(x, kRegions, 3, round), next) << round;
    if (round == 15) {
      EXPECT_EQ(KMeans(x, kRegions, 3), next);
    }
    region = next;
  }
}

/// A model of one sample at the origin, of other parameters than the default ones.
LocalMixture MixtureAtTheOrigin() {
  const GaussianProcessParameters p{2e-3, 5e-4, 30.0, 5e3};
  return LocalMixture({{p, Eigen::RowVector2d(0.0, 0.0), Eigen::RowVector3d(0.1, 0.0, 0.0)}});
}

// Algorithm 2: similarity exp(-15 d^2) to the mean of a model's samples; at 0.39 m it is 0.102.
TEST(LocalMixture, UpdatesTheCentreOfTheModel) {
  LocalMixture mixture = MixtureAtTheOrigin();
  const Eigen::VectorXd at = Eigen::Vector2d(0.39, 0.0);
  EXPECT_NEAR(mixture.Similarity(at), std::exp(-15.0 * 0.39 * 0.39), 1e-12);
  mixture.Update(at, Eigen::Vector3d::Zero(), {});
  EXPECT_EQ(mixture.models().size(), 1u);
  EXPECT_NEAR(mixture.Similarity(at), std::exp(-15.0 * 0.195 * 0.195), 1e-12);
}

TEST(LocalMixture, NewModelsHaveTheParametersOfTheMostSimilarOneAndAreBounded) {
  LocalMixture mixture = MixtureAtTheOrigin();
  LocalMixtureOptions options;
  options.most_models = 3;
  for (const double x : {0.4, 1.0, 2.0}) {  // similarities below 0.1
    mixture.Update(Eigen::Vector2d(x, 0.0), Eigen::Vector3d::Zero(), options);
  }
  ASSERT_EQ(mixture.models().size(), 3u);
  EXPECT_EQ(mixture.models().back().parameters().beta, 5e3);
  EXPECT_EQ(mixture.models().back().parameters().theta0, 2e-3);
}

// Of a person who stands still: one sample, or the same one again and again.
TEST(LocalMixture, LearnsFromASingleSampleAndFromEqualOnes) {
  for (const Eigen::Index count : {1, 80}) {
    const Eigen::MatrixXd x = Eigen::RowVector2d(0.3, -0.1).replicate(count, 1);
    const Eigen::MatrixXd y = Eigen::RowVector3d(0.05, 0.0, -0.02).replicate(count, 1);
    const GaussianPrediction made = LocalMixture::Learn(x, y, {}).Predict(x.row(0).transpose(), 9);
    EXPECT_LT((made.mean - y.row(0).transpose()).norm(), 0.01) << count;
    EXPECT_TRUE(std::isfinite(made.variance)) << count;
  }
}

// Sec. 4.2.3: online, too, posture budgeting keeps a model small, and it goes on learning.
TEST(LocalMixture, IsBudgetedWhileItLearns) {
  const Samples s = MakeSamples(60);
  LocalMixtureOptions options;
  options.regions = 1;
  options.most_samples = 40;
  LocalMixture mixture = LocalMixture::Learn(s.x, s.y, options);
  const Eigen::VectorXd at = s.x.row(0).transpose();
  const Eigen::Vector3d other(0.3, 0.2, 0.1);
  const double before = (mixture.Predict(at, 1).mean - other).norm();
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd near = at + Eigen::Vector2d(1e-3 * i, 1e-3 * (i % 7));
    mixture.Update(near, other, options);
    EXPECT_LE(mixture.models()[0].size(), options.most_samples);
  }
  EXPECT_LT((mixture.Predict(at, 1).mean - other).norm(), 0.5 * before);
}

TEST(LocalMixture, CombinesTheNoiseOfThePredictingModels) {
  const Samples s = MakeSamples(40);
  GaussianProcessParameters quiet, loud;
  quiet.beta = 1e6, loud.beta = 1e2;
  const Eigen::MatrixXd far = s.x.bottomRows(20).array() + 9.0;
  const LocalMixture mixture(
      {{quiet, s.x.topRows(20), s.y.topRows(20)}, {loud, far, s.y.bottomRows(20)}});
  EXPECT_NEAR(mixture.Predict(s.x.row(3).transpose(), 2).noise, 1e-6, 1e-9);
  EXPECT_NEAR(mixture.Predict(far.row(3).transpose(), 2).noise, 1e-2, 1e-6);
}

}  // namespace
}  // namespace ossa::recon
