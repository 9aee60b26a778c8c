#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "recon/database/nearest.h"
#include "recon/methods/bone_turns_internal.h"
#include "recon/methods/posture_space_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/orientation.h"
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

/// Mean error over a second of increasingly bad guesses for a stationary person, after two seconds
/// of good observations.
double ErrorWhileAllIsGuessed_m(const std::string& name) {
  ReconstructorOptions options;
  options.method = name;
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  const auto method = MakeReconstructor(options);
  const auto truth = [](int f) {
    return test::InFrontOfCamera(test::Motion(std::min(f, 60) / 30.0));
  };
  double sum_m = 0.0;
  for (int f = 0; f < 90; ++f) {
    TrackedPosture seen = test::AllTracked(truth(f));
    if (f >= 60) {
      seen.state.fill(TrackingState::kInferred);
      for (size_t i = 4; i < 12; ++i) seen.posture.position_m[i].y() += 0.01 * (f - 60);
    }
    const auto made = method->Step({seen, f / 30.0, nullptr});
    if (f >= 75) sum_m += test::MeanDistance_m(made.posture, truth(f)) / 15;
  }
  return sum_m;
}

TEST(Shum2013, HoldsThePostureWhileNothingIsReliable) {
  // As good as the database is: postures every 20 cm of the fastest joint.
  EXPECT_LT(ErrorWhileAllIsGuessed_m("shum-2013"), 0.06);
  EXPECT_LT(ErrorWhileAllIsGuessed_m("plantard-2016"), 0.06);
}

// Sec. VII-B: w_n = 1 / sum over i of R_i (p_i - p_i^n)^2, eq. 9.
TEST(InverseDistances, EqualEquation9) {
  const auto db = PostureDatabase::Build(test::GestureClips(), {});
  const PostureVector made = ToVector(test::Motion(0.7));
  JointWeights reliability;
  for (size_t i = 0; i < kJointCount; ++i) reliability[i] = 0.05 * static_cast<double>(i);
  const int neighbours[] = {0, 5, 17};
  const auto weights = InverseDistances(db, neighbours, made, reliability);
  for (size_t n = 0; n < 3; ++n) {
    const Posture other = db.posture(neighbours[n]);
    double d = 0.0;
    for (size_t i = 0; i < kJointCount; ++i) {
      const Eigen::Vector3d p = ToPosture(made).position_m[i];
      d += reliability[i] * (p - other.position_m[i]).squaredNorm();
    }
    EXPECT_NEAR(weights[n] * (d + 1e-4), 1.0, 1e-4);  // single precision
  }
}

TEST(PostureSpace, ReproducesItsNeighboursUpToTheStatedResidual) {
  const Problem p = MakeProblem(1.0, false);
  EXPECT_LE(p.space.dimensions(), 20);
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
// 0.1 m and half believed, 0.1 m from the nearest of two neighbours, expected at 0.25 m.
TEST(Energies, EqualEquation15) {
  Problem p;
  const Eigen::Index head = FirstCoordinate(Index(Joint::kHead));
  p.space.basis.setZero(kPostureDims, 1);
  p.space.basis(head, 0) = 1.0F;
  p.space.neighbours.resize(1, 2);
  p.space.neighbours << 0.2F, 0.6F;
  p.space.outside.setZero(2);
  p.inputs.observed[head] = 0.1F;
  p.inputs.reliability[Index(Joint::kHead)] = 0.5;
  p.inputs.lengths_m[Index(Joint::kHead)] = 0.2;
  p.inputs.last.emplace(PostureVector::Zero())[head] = 0.2F;
  p.inputs.before_last.emplace(PostureVector::Zero())[head] = 0.15F;
  const Eigen::MatrixXf q = Eigen::MatrixXf::Constant(1, 1, 0.3F);
  const double control = 0.5 * 0.04, style = 0.01 / 20, kinematics = 0.01 / 19;
  const double continuity = 0.0025 / 20;
  const double expected = control + 0.5 * style + 1.5 * kinematics + 0.25 * continuity;  // 0.02107
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

/// Mean angle between a method's orientations and what joints tell of them, of bones whose turn
/// joints tell well, after a second of postures that the database does not have and is extended by.
double TurnedApart_deg(bool extend) {
  ReconstructorOptions options;
  options.method = "shum-2013";
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  options.local_pca.extend_database = extend;
  const auto method = MakeReconstructor(options);
  double sum_rad = 0.0;
  constexpr int kFrames = 30, kFrom = 15;
  for (int f = 0; f < kFrames; ++f) {
    Posture truth = test::Motion(f / 30.0);
    for (const Joint joint : {Joint::kAnkleLeft, Joint::kFootLeft}) {  // a shin held back
      truth[joint] += Eigen::Vector3d(0.0, 0.12, -0.35);
    }
    const auto made =
        method->Step({test::AllTracked(test::InFrontOfCamera(truth)), f / 30.0, nullptr});
    const auto told = ComputeOrientations(made.posture);
    for (const size_t bone : {1U, 2U, 4U, 8U, 13U, 17U}) {
      if (f >= kFrom) sum_rad += (*made.orientation)[bone].angularDistance(told[bone]);
    }
  }
  return sum_rad / (6.0 * (kFrames - kFrom)) * 180.0 / M_PI;
}

TEST(Shum2013, AddedPosturesHaveOrientations) {
  EXPECT_LT(TurnedApart_deg(true), TurnedApart_deg(false) + 5.0);
}

/// Distance of the head from its observation, for a bow that is not in the database.
double ErrorOfABowedHead_m(bool keep_reliable) {
  ReconstructorOptions options;
  options.method = "shum-2013";
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  options.local_pca.keep_reliable = keep_reliable;
  const auto method = MakeReconstructor(options);
  Posture truth;
  ReconstructedPosture made;
  for (int f = 0; f < 10; ++f) {
    truth = test::Gesture(0.3, 0.3, 0.2);
    truth[Joint::kHead] += Eigen::Vector3d(0.0, -0.06, 0.15);
    truth = test::InFrontOfCamera(truth);
    made = method->Step({test::AllTracked(truth), f / 30.0, nullptr});
  }
  return (made.posture[Joint::kHead] - truth[Joint::kHead]).norm();
}

TEST(Shum2013, KeepsReliableJointsFarFromTheDatabase) {
  // The space of upright heads cannot bow one; a reliable head nearly stays.
  EXPECT_GT(ErrorOfABowedHead_m(false), 0.1);
  EXPECT_LT(ErrorOfABowedHead_m(true), 0.02);
}

}  // namespace
}  // namespace ossa::recon
