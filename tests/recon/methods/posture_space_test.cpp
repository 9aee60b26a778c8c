#include "recon/methods/posture_space_internal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "recon/database/nearest.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

struct Problem {
  PostureSpace space;
  EnergyInputs inputs;
};

Problem MakeProblem(double t_s, bool history) {
  static const auto db = PostureDatabase::Build(test::GestureClips(), {});
  Problem p;
  p.inputs.observed = ToVector(test::Motion(t_s));
  p.inputs.reliability.fill(1.0);
  p.inputs.reliability[7] = 0.0;
  p.inputs.reliability[9] = 0.4;
  p.inputs.lengths_m = db.bone_lengths_m();
  if (history) {
    p.inputs.last = ToVector(test::Motion(t_s - 1.0 / 30));
    p.inputs.before_last = ToVector(test::Motion(t_s - 2.0 / 30));
  }
  std::vector<int> neighbours;
  for (const auto& n : NearestPostures(db, p.inputs.observed, p.inputs.reliability, 30)) {
    neighbours.push_back(n.index);
  }
  p.space = MakePostureSpace(db, neighbours, 20);
  return p;
}

TEST(PostureSpace, ReproducesItsNeighboursUpToTheStatedResidual) {
  const Problem p = MakeProblem(1.0, false);
  EXPECT_LE(p.space.dimensions(), 20);
  EXPECT_EQ(MakePostureSpace(PostureDatabase::Build(test::GestureClips(), {}),
                             std::array{0, 5, 17, 30}, 2)
                .dimensions(),
            2);
  const Eigen::MatrixXf gram = p.space.basis.transpose().lazyProduct(p.space.basis);
  EXPECT_LT((gram - Eigen::MatrixXf::Identity(gram.rows(), gram.cols())).norm(), 1e-3F);
  EXPECT_LT(p.space.outside.maxCoeff(), 0.05F);
}

/// Of the k postures nearest to one of the motion's.
PostureSpace SpaceOf(const PostureDatabase& db, int k) {
  JointWeights all;
  all.fill(1.0);
  std::vector<int> neighbours;
  for (const auto& n : NearestPostures(db, ToVector(test::Motion(1.0)), all, k)) {
    neighbours.push_back(n.index);
  }
  return MakePostureSpace(db, neighbours, 20);
}

// On both sides of K = 60, where another matrix is decomposed: the scatter of the neighbours from
// their mean, rotated into the space, is diagonal, and its entries are K times the variances.
TEST(PostureSpace, HasThePrincipalDirectionsOfAnyNumberOfNeighbours) {
  DatabaseOptions all;
  all.threshold_m = 1e-4;
  const auto db = PostureDatabase::Build(test::GestureClips(), all);
  ASSERT_GE(db.size(), 400);
  for (const int k : {30, 60, 61, 400}) {
    const PostureSpace space = SpaceOf(db, k);
    ASSERT_GT(space.dimensions(), 1) << k;
    const Eigen::MatrixXf scatter = space.neighbours * space.neighbours.transpose();
    const Eigen::VectorXf expected = space.deviation.array().square() * static_cast<float>(k);
    EXPECT_LT((scatter - Eigen::MatrixXf(expected.asDiagonal())).cwiseAbs().maxCoeff(),
              1e-4F * expected[0])
        << k;  // single precision
    EXPECT_TRUE(std::is_sorted(expected.begin(), expected.end(), std::greater<>())) << k;
    const Eigen::MatrixXf gram = space.basis.transpose().lazyProduct(space.basis);
    EXPECT_LT((gram - Eigen::MatrixXf::Identity(gram.rows(), gram.cols())).norm(), 1e-3F) << k;
  }
}

TEST(EnergyResiduals, HaveTheirJacobian) {
  for (const bool history : {false, true}) {
    const Problem p = MakeProblem(1.0, history);
    const EnergyResiduals residuals(p.space, p.inputs, {}, 3);
    const Eigen::VectorXd q = 0.5 * p.space.neighbours.col(5).cast<double>();
    Eigen::VectorXd r, plus, minus;
    Eigen::MatrixXd jacobian;
    residuals.Evaluate(q, r, &jacobian);
    constexpr double kStep = 1e-6;  // central differences: error of order 1e-10
    for (Eigen::Index c = 0; c < q.size(); ++c) {
      Eigen::VectorXd moved = q;
      moved[c] += kStep;
      residuals.Evaluate(moved, plus, nullptr);
      moved[c] -= 2 * kStep;
      residuals.Evaluate(moved, minus, nullptr);
      const Eigen::VectorXd numeric = (plus - minus) / (2 * kStep);
      EXPECT_LT((numeric - jacobian.col(c)).cwiseAbs().maxCoeff(), 1e-6) << "column " << c;
    }
  }
}

TEST(EnergyResiduals, SumOfSquaresIsTheEnergyOfEquation15) {
  const Problem p = MakeProblem(0.4, true);
  const Eigen::VectorXf q = p.space.neighbours.col(4);  // its own nearest neighbour
  const EnergyResiduals residuals(p.space, p.inputs, {}, 4);
  Eigen::VectorXd r;
  residuals.Evaluate(q.cast<double>(), r, nullptr);
  const double outside = 0.5 * p.space.outside[4] / kJointCount;  // constant, not a residual
  const float energy = Energies(p.space, p.inputs, {}, q.transpose())[0];
  EXPECT_NEAR(r.squaredNorm() + outside, energy, 1e-4 * energy);  // single precision
}

// In numbers: one dimension, the head's x. The head at 0.3 m, its bone wanted 0.2 m long, seen at
// 0.1 m and half believed, expected at 0.25 m. Of two neighbours the one at 0.2 m lies half a metre
// beside the space: the nearest is the other one, 0.3 m away.
TEST(Energies, EqualEquation15) {
  Problem p;
  const Eigen::Index head = FirstCoordinate(Index(Joint::kHead));
  p.space.basis.setZero(kPostureDims, 1);
  p.space.basis(head, 0) = 1.0F;
  p.space.neighbours.resize(1, 2);
  p.space.neighbours << 0.2F, 0.6F;
  p.space.outside.resize(2);
  p.space.outside << 0.25F, 0.0F;
  p.inputs.observed[head] = 0.1F;
  p.inputs.reliability[Index(Joint::kHead)] = 0.5;
  p.inputs.lengths_m[Index(Joint::kHead)] = 0.2;
  p.inputs.last.emplace(PostureVector::Zero())[head] = 0.2F;
  p.inputs.before_last.emplace(PostureVector::Zero())[head] = 0.15F;
  const Eigen::MatrixXf q = Eigen::MatrixXf::Constant(1, 1, 0.3F);
  const double control = 0.5 * 0.04, style = 0.09 / 20, kinematics = 0.01 / 19;
  const double continuity = 0.0025 / 20;
  const double expected = control + 0.5 * style + 1.5 * kinematics + 0.25 * continuity;
  EXPECT_NEAR(Energies(p.space, p.inputs, {}, q)[0], expected, 1e-6);  // single precision
}

TEST(SearchStochastic, IsDeterministicForASeed) {
  const Problem p = MakeProblem(1.7, true);
  const Eigen::VectorXf start = p.space.neighbours.col(0);
  EXPECT_EQ(SearchStochastic(p.space, p.inputs, {}, start, 3).q,
            SearchStochastic(p.space, p.inputs, {}, start, 3).q);
}

// From the neighbour farthest off, as after a jump.
TEST(SearchStochastic, ImprovesOnItsStart) {
  for (const double t : {0.3, 1.1, 1.7, 2.4}) {
    const Problem p = MakeProblem(t, true);
    const Eigen::VectorXf start = p.space.neighbours.rightCols(1);
    const double before = Energies(p.space, p.inputs, {}, start.transpose())[0];
    EXPECT_LT(SearchStochastic(p.space, p.inputs, {}, start, 3).energy, 0.5 * before) << t;
  }
}

// Two searches of the same energy: the results differ by less than a seventh.
TEST(Searches, FindTheSameMinimum) {
  for (const double t : {0.3, 1.1, 2.4}) {
    const Problem p = MakeProblem(t, true);
    const Eigen::VectorXf start = p.space.neighbours.col(0);
    const auto random = SearchStochastic(p.space, p.inputs, {}, start, 1);
    const auto exact = SearchCeres(p.space, p.inputs, {}, start);
    EXPECT_LE(exact.energy, 1.15 * random.energy) << t;
    EXPECT_LE(random.energy, 1.15 * exact.energy) << t;
  }
}

/// A posture space of one dimension, the head's x, with two neighbours.
Problem HeadProblem(float first_m, float second_m) {
  Problem p;
  const Eigen::Index head = FirstCoordinate(Index(Joint::kHead));
  p.space.basis.setZero(kPostureDims, 1);
  p.space.basis(head, 0) = 1.0F;
  p.space.neighbours.resize(1, 2);
  p.space.neighbours << first_m, second_m;
  p.space.outside.setZero(2);
  p.inputs.reliability[Index(Joint::kHead)] = 1.0;
  p.inputs.observed[head] = 0.9F;
  return p;
}

// From 0.4, nearest to the neighbour at 0, the minimum is at 0.675, which is nearest to the one at
// 1: its minimum is (3 x 0.9 + 1) / 4.
TEST(SearchCeres, ChangesTheNearestNeighbourAsItMoves) {
  const Problem p = HeadProblem(0.0F, 1.0F);
  LocalPcaOptions options;
  options.control = 3.0;
  options.style = kJointCount;  // a weight of 1 for one joint
  options.kinematics = options.continuity = 0.0;
  const auto found = SearchCeres(p.space, p.inputs, options, Eigen::VectorXf::Constant(1, 0.4F));
  EXPECT_NEAR(found.q[0], 0.925, 1e-3);
}

// The neighbour at 0.2 lies half a metre beside the space: the style term draws from 0.3 to 0.6.
TEST(SearchCeres, CountsTheDistanceOfNeighboursFromTheSpace) {
  Problem p = HeadProblem(0.2F, 0.6F);
  p.space.outside << 0.25F, 0.0F;
  LocalPcaOptions options;
  options.control = options.kinematics = options.continuity = 0.0;
  const auto found = SearchCeres(p.space, p.inputs, options, Eigen::VectorXf::Constant(1, 0.3F));
  EXPECT_NEAR(found.q[0], 0.6, 1e-3);
}

}  // namespace
}  // namespace ossa::recon
