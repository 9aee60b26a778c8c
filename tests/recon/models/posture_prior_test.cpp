#include "recon/models/posture_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "depth/base/error.h"
#include "recon/models/prior_filter.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

PriorClip GesturesFor(double seconds, double from_s = 0.0) {
  PriorClip clip;
  for (double t = 0.0; t < seconds; t += kFrame_s) {
    clip.postures.push_back(test::Motion(from_s + t));
  }
  return clip;
}

std::shared_ptr<const PosturePrior> Learned() {
  static const auto prior =
      std::make_shared<const PosturePrior>(PosturePrior::Learn({GesturesFor(120.0)}));
  return prior;
}

/// An observation of all joints of a posture, with this standard deviation.
PriorObservation Seeing(const Posture& posture, double sd_m) {
  PriorObservation observation;
  observation.seen = posture;
  observation.sd_m.fill(sd_m);
  observation.lengths_m = StandardBoneLengths();
  observation.root_sd_m = 1e-4;
  return observation;
}

TEST(PosturePrior, HasMeanAndCovarianceOfThePosturesAndTheirMirrorImages) {
  const PriorClip clip = GesturesFor(40.0);
  std::vector<BoneVector> bones;
  for (const Posture& posture : clip.postures) {
    bones.push_back(ToBoneVector(posture));
    bones.push_back(ToBoneVector(Mirrored(posture)));
  }
  BoneVector mean = BoneVector::Zero();
  for (const BoneVector& b : bones) mean += b / static_cast<double>(bones.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kBoneDims, kBoneDims);
  for (const BoneVector& b : bones) {
    covariance += (b - mean) * (b - mean).transpose() / static_cast<double>(bones.size());
  }
  const PosturePrior prior = PosturePrior::Learn({clip}, {.modes = kBoneDims});
  EXPECT_LT((prior.mean_m - mean).norm(), 1e-9);
  // What hardly moves is no mode: 0.1 mm squared of variance in each.
  EXPECT_LT((prior.modes_m * prior.modes_m.transpose() - covariance).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(PosturePrior, ModesStayUncorrelatedAfterALag) {
  const PriorClip clip = GesturesFor(40.0);
  const PosturePriorOptions options;
  const PosturePrior prior = PosturePrior::Learn({clip}, options);
  const auto lag = static_cast<size_t>(std::round(options.lag_s / kFrame_s));
  const Eigen::MatrixXd modes_of = prior.modes_m.completeOrthogonalDecomposition().pseudoInverse();
  Eigen::MatrixXd kept =
      Eigen::MatrixXd::Zero(prior.correlation_time_s.size(), prior.correlation_time_s.size());
  for (size_t f = 0; f + lag < clip.postures.size(); ++f) {
    for (const bool mirrored : {false, true}) {
      const auto modes = [&](size_t frame) -> Eigen::VectorXd {
        const Posture& p = clip.postures[frame];
        return modes_of * (ToBoneVector(mirrored ? Mirrored(p) : p) - prior.mean_m);
      };
      const Eigen::MatrixXd product = modes(f) * modes(f + lag).transpose();
      kept +=
          0.25 * (product + product.transpose()) / static_cast<double>(clip.postures.size() - lag);
    }
  }
  // Times follow from what is kept; both are clamped where next to nothing or nearly all is.
  for (Eigen::Index k = 0; k < prior.correlation_time_s.size(); ++k) {
    const double expected_s =
        -options.slowness * options.lag_s / std::log(std::clamp(kept(k, k), 0.02, 0.9999));
    EXPECT_NEAR(prior.correlation_time_s[k] / expected_s, 1.0, 1e-3) << k;
    kept(k, k) = 0.0;
  }
  EXPECT_LT(kept.cwiseAbs().maxCoeff(), 1e-3);
}

TEST(PosturePrior, RefusesMotionsShorterThanALag) {
  const std::vector<PriorClip> clips(30, GesturesFor(0.2));
  ossa::test::ExpectRefused([&] { PosturePrior::Learn(clips); },
                            "expected a motion that is longer than 0.33 s");
}

TEST(PosturePrior, FileIsDeterministicAndReadsBack) {
  const ossa::test::TemporaryFolder folder;
  for (const char* name : {"a.ossaprior", "b.ossaprior"}) {
    PosturePrior::Learn({GesturesFor(10.0)}).Save(folder / name);
  }
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.ossaprior"), bytes("b.ossaprior"));
  EXPECT_TRUE(PosturePrior::IsFile(folder / "a.ossaprior"));
  PosturePrior::Load(folder / "a.ossaprior").Save(folder / "c.ossaprior");
  EXPECT_EQ(bytes("a.ossaprior"), bytes("c.ossaprior"));
}

TEST(PosturePrior, ContainsNoPostureOfTheData) {
  const ossa::test::TemporaryFolder folder;
  const PriorClip clip = GesturesFor(20.0);
  const PosturePrior prior = PosturePrior::Learn({clip});
  prior.Save(folder / "short.ossaprior");
  PosturePrior::Learn({clip, GesturesFor(60.0)}).Save(folder / "long.ossaprior");
  // Sums over all frames, however many there are.
  EXPECT_EQ(std::filesystem::file_size(folder / "short.ossaprior"),
            std::filesystem::file_size(folder / "long.ossaprior"));
  for (const Posture& posture : clip.postures) {
    EXPECT_GT((ToBoneVector(posture) - prior.mean_m).norm(), 0.02);
  }
}

TEST(PosturePrior, RefusesDamagedFilesByName) {
  const ossa::test::TemporaryFolder folder;
  Learned()->Save(folder / "a.ossaprior");
  std::ifstream in(folder / "a.ossaprior", std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(in), {});
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 1);
  for (const std::string& bad : {whole.substr(0, 20), whole.substr(0, whole.size() - 1), damaged}) {
    std::ofstream(folder / "bad.ossaprior", std::ios::binary) << bad;
    ossa::test::ExpectRefused([&] { PosturePrior::Load(folder / "bad.ossaprior"); },
                              "bad.ossaprior");
  }
}

TEST(PosturePrior, RefusesInvalidNumbers) {
  const ossa::test::TemporaryFolder folder;
  const auto refused = [&](void (*spoil)(PosturePrior&), const char* field) {
    PosturePrior prior = *Learned();
    spoil(prior);
    prior.Save(folder / "odd.ossaprior");
    ossa::test::ExpectRefused([&] { PosturePrior::Load(folder / "odd.ossaprior"); }, field);
  };
  refused([](PosturePrior& p) { p.mean_m[3] = std::nan(""); }, "mean");
  refused([](PosturePrior& p) { p.residual_m2[3] = -1.0; }, "rest");
  refused([](PosturePrior& p) { p.correlation_time_s[0] = 0.0; }, "correlation times");
  refused([](PosturePrior& p) { p.correlation_time_s.resize(0); }, "correlation times");
  refused([](PosturePrior& p) { p.modes_m(0, 0) = std::numeric_limits<double>::infinity(); },
          "modes");
  refused([](PosturePrior& p) { p.modes_m.conservativeResize(kBoneDims, 2); }, "modes");
}

TEST(PosturePrior, RefusesDataWithoutMotion) {
  PriorClip still;
  still.postures.assign(200, test::Gesture(0.3, 0.3, 0.2));
  EXPECT_THROW(PosturePrior::Learn({still}), InputError);
  EXPECT_THROW(PosturePrior::Learn({}), InputError);
  PriorClip broken = GesturesFor(20.0);
  for (Posture& p : broken.postures) p.position_m[3].x() = std::nan("");
  EXPECT_THROW(PosturePrior::Learn({broken}), InputError);
  EXPECT_THROW(PosturePrior::Learn({still}, {.modes = 0}), std::invalid_argument);
}

/// The posterior of the modes at the last of several moments, from the joint Gaussian of all of
/// them at once.
BoneVector BruteForce(const PosturePrior& prior, const std::vector<double>& times_s,
                      const std::vector<PriorObservation>& seen) {
  const Eigen::Index d = prior.correlation_time_s.size(),
                     moments = static_cast<Eigen::Index>(seen.size());
  std::vector<Eigen::RowVectorXd> rows;  // of all modes at all moments
  std::vector<double> values, noise;
  std::vector<std::pair<Eigen::Index, int>> axes;  // moment and axis: they share the root's error
  for (Eigen::Index m = 0; m < moments; ++m) {
    const auto& o = seen[static_cast<size_t>(m)];
    for (size_t j = 1; j < kJointCount; ++j) {
      if (o.sd_m[j] == 0.0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(moments * d);
        double mean = 0.0, rest = o.sd_m[j] * o.sd_m[j];
        for (size_t i = j; i != 0; i = ParentOf(i)) {
          const auto at = FirstCoordinate(i - 1) + axis;
          row.segment(m * d, d) += prior.modes_m.row(at);
          mean += prior.mean_m[at];
          rest += prior.residual_m2[at];
        }
        rows.push_back(row);
        values.push_back(o.seen.position_m[j][axis] - mean);
        noise.push_back(rest);
        axes.emplace_back(m, axis);
      }
    }
  }
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(moments * d, moments * d);
  for (Eigen::Index a = 0; a < moments; ++a) {
    for (Eigen::Index b = 0; b < moments; ++b) {
      const double apart_s =
          std::abs(times_s[static_cast<size_t>(a)] - times_s[static_cast<size_t>(b)]);
      joint.block(a * d, b * d, d, d).diagonal() =
          (-apart_s / prior.correlation_time_s.array()).exp();
    }
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd h(n, moments * d), r = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    h.row(i) = rows[static_cast<size_t>(i)];
    y[i] = values[static_cast<size_t>(i)];
    r(i, i) = noise[static_cast<size_t>(i)];
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto [moment, axis] = axes[static_cast<size_t>(i)];
      if (axes[static_cast<size_t>(k)] != std::pair{moment, axis}) continue;
      r(i, k) += std::pow(seen[static_cast<size_t>(moment)].root_sd_m, 2);
    }
  }
  const Eigen::MatrixXd spread = h * joint * h.transpose() + r;
  const Eigen::VectorXd u = joint * h.transpose() * spread.ldlt().solve(y);
  return prior.mean_m + prior.modes_m * u.tail(d);
}

TEST(PriorFilter, EqualsTheExactPosterior) {
  const auto prior = Learned();
  const std::vector<double> times_s = {0.0, 0.05, 0.3, 0.9};
  std::vector<PriorObservation> seen;
  std::mt19937_64 rng(5);
  for (size_t m = 0; m < times_s.size(); ++m) {
    PriorObservation& o = seen.emplace_back(Seeing(test::Motion(1.0 + times_s[m]), 0.0));
    test::AddNoise(o.seen, 0.02, rng);
    o.root_sd_m = m == 2 ? 0.1 : 0.01;
    for (size_t j = m; j < kJointCount; j += 2 + m)
      o.sd_m[j] = 0.01 * static_cast<double>(1 + j % 3);
  }
  PriorFilter filter(prior);
  Posture last;
  for (size_t m = 0; m < times_s.size(); ++m) {
    last = filter.Step(m == 0 ? 0.0 : times_s[m] - times_s[m - 1], seen[m]);
  }
  const Posture expected =
      Retargeted(PostureFromBones(BruteForce(*prior, times_s, seen)), StandardBoneLengths());
  const Eigen::Vector3d root = last.position_m[0];
  for (size_t j = 0; j < kJointCount; ++j) {
    // Both solve the same equations in double precision.
    EXPECT_LT((last.position_m[j] - root - expected.position_m[j]).norm(), 1e-6) << j;
  }
}

TEST(PriorFilter, HiddenArmFollowsTheOther) {
  // People who always move both arms alike, and bend their forearms as they please.
  PriorClip alike;
  for (double t = 0.0; t < 120.0; t += kFrame_s) {
    const double lift = 0.9 + 0.8 * std::sin(0.8 * t);
    alike.postures.push_back(test::Gesture(lift, lift, 0.7 + 0.6 * std::sin(1.7 * t)));
  }
  PriorFilter filter(std::make_shared<PosturePrior>(PosturePrior::Learn({alike})));
  const auto& truth = alike.postures;
  filter.Step(0.0, Seeing(truth[0], 0.005));
  double off_m = 0.0, held_off_m = 0.0;
  for (size_t f = 1; f < 90; ++f) {
    PriorObservation observation = Seeing(truth[f], 0.005);
    for (const size_t hidden : {5U, 6U, 7U}) observation.sd_m[hidden] = 0.0;
    const Posture made = filter.Step(kFrame_s, observation);
    off_m += (made.position_m[7] - truth[f].position_m[7]).norm() / 89.0;
    held_off_m += (truth[0].position_m[7] - truth[f].position_m[7]).norm() / 89.0;
  }
  EXPECT_LT(off_m, 0.15 * held_off_m);
}

TEST(PriorFilter, IsEquivariantUnderMirroring) {
  PriorFilter one(Learned()), other(Learned());
  for (int f = 0; f < 20; ++f) {
    PriorObservation observation = Seeing(test::Motion(f * kFrame_s), 0.01);
    for (size_t j = 5; j < 8; ++j) observation.sd_m[j] = f > 3 ? 0.0 : 0.01;
    PriorObservation mirrored = observation;
    mirrored.seen = Mirrored(observation.seen);
    for (size_t j = 0; j < kJointCount; ++j) {
      mirrored.sd_m[j] = observation.sd_m[kMirroredJoint[j]];
    }
    const Posture a = Mirrored(one.Step(kFrame_s, observation));
    EXPECT_LT(test::MeanDistance_m(a, other.Step(kFrame_s, mirrored)), 1e-6) << f;
  }
}

TEST(PriorFilter, ConvergesToTheMeanWithoutObservations) {
  PriorFilter filter(Learned());
  const Posture usual = filter.Step(0.0, Seeing({}, 0.0));
  const double anything_m = filter.Uncertainty_m(Joint::kHandLeft);
  filter.Step(kFrame_s, Seeing(test::Motion(2.0), 0.005));
  EXPECT_LT(filter.Uncertainty_m(Joint::kHandLeft), 0.1 * anything_m);
  Posture made;
  for (int f = 0; f < 100; ++f) {
    made = filter.Step(1e3, Seeing({}, 0.0));
    for (const auto& p : made.position_m) ASSERT_TRUE(p.allFinite());
  }
  EXPECT_LT(test::MeanDistance_m(made, usual), 1e-6);
  EXPECT_NEAR(filter.Uncertainty_m(Joint::kHandLeft), anything_m, 1e-6);
}

TEST(PriorFilter, UsesThePersonsBoneLengths) {
  for (const double scale : {0.9 / 1.66, 2.2 / 1.66}) {
    PriorFilter filter(Learned());
    PriorObservation observation = Seeing(Scaled(test::Motion(1.0), scale), 0.002);
    observation.lengths_m = ScaledBoneLengths(scale);
    Posture made;
    for (int f = 0; f < 5; ++f) made = filter.Step(kFrame_s, observation);
    EXPECT_LT(test::MeanDistance_m(made, observation.seen), 0.01);
    EXPECT_NEAR(MeasureBoneLengths(made)[9], observation.lengths_m[9], 1e-9);
  }
}

}  // namespace
}  // namespace ossa::recon
