#include "recon/fit/normal_equations.h"

#include <Eigen/LU>

#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {
namespace {

PosedSurface PosedAt(const SurfacePose& pose) {
  PosedSurface posed(Surface());
  posed.PoseSegments(pose);
  posed.PosePoints();
  return posed;
}

// The gradient of one residual of weight 1 and value 1 is its derivative by every unknown: against
// central differences of the place itself, moved by steps of 1e-5 rad, m and standard deviations.
TEST(NormalEquations, DerivativeOfAPositionEqualsFiniteDifferences) {
  constexpr double kStep = 1e-5, kTolerance = 1e-7;  // of second order in the step
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const PosedSurface posed = PosedAt(RandomPose(seed));
    for (size_t i = 0; i < posed.at_m().size(); i += 61) {
      const SurfacePoint& point = Surface().points[i];
      const Eigen::Vector3d along = Eigen::Vector3d(1, 2, -3).normalized();
      NormalEquations equations;
      equations.Clear();
      equations.Add(
          point.segment,
          RowOfPlace(posed, point.segment, posed.at_m()[i], along, point.place.by_shape_m), 1.0,
          1.0);
      equations.Assemble(posed);
      for (int k = 0; k < kFitUnknowns; ++k) {
        const FitStep step = kStep * FitStep::Unit(k);
        const double ahead = PosedAt(Moved(posed, step, 1.0)).at_m()[i].dot(along);
        const double back = PosedAt(Moved(posed, -step, 1.0)).at_m()[i].dot(along);
        EXPECT_NEAR(equations.gradient()[k], (ahead - back) / (2 * kStep), kTolerance)
            << "point " << i << ", unknown " << k;
      }
    }
  }
}

// A residual's square has the outer product of its derivative as matrix.
TEST(NormalEquations, HessianIsTheOuterProductOfTheJacobian) {
  const PosedSurface posed = PosedAt(RandomPose(4));
  const size_t i = posed.at_m().size() - 1;
  const SurfacePoint& point = Surface().points[i];
  NormalEquations equations;
  equations.Clear();
  equations.Add(point.segment,
                RowOfPlace(posed, point.segment, posed.at_m()[i], Eigen::Vector3d::UnitX(),
                           point.place.by_shape_m),
                1.0, 1.0);
  equations.Assemble(posed);
  const FitStep& derivative = equations.gradient();
  for (int r = 0; r < kFitUnknowns; ++r) {
    for (int c = 0; c <= r; ++c) {
      EXPECT_NEAR(equations.matrix()(r, c), derivative[r] * derivative[c], 1e-12);
    }
  }
}

// Three rows fix a place: the step takes it there, to first order.
TEST(NormalEquations, StepMovesAPositionToItsTarget) {
  const PosedSurface posed = PosedAt(RandomPose(6));
  const size_t i = 17;
  const SurfacePoint& point = Surface().points[i];
  const Eigen::Vector3d off_m(0.004, -0.003, 0.002);
  NormalEquations equations;
  equations.Clear();
  for (int axis = 0; axis < 3; ++axis) {
    equations.Add(point.segment,
                  RowOfPlace(posed, point.segment, posed.at_m()[i], Eigen::Vector3d::Unit(axis),
                             point.place.by_shape_m),
                  -off_m[axis], 1e4);
  }
  equations.Assemble(posed);
  const PosedSurface moved = PosedAt(Moved(posed, equations.Solve(0.0), 1.0));
  EXPECT_LT((moved.at_m()[i] - posed.at_m()[i] - off_m).norm(), 1e-4);
}

// Terms on a surface's points and rotations, as in a fit.
NormalEquations EquationsOf(const PosedSurface& posed) {
  NormalEquations equations;
  equations.Clear();
  for (size_t i = 0; i < posed.at_m().size(); i += 7) {
    const SurfacePoint& point = Surface().points[i];
    equations.Add(point.segment,
                  RowOfPlace(posed, point.segment, posed.at_m()[i], posed.normal()[i],
                             point.place.by_shape_m),
                  0.01, 400.0);
  }
  equations.Assemble(posed);
  for (size_t s = 1; s < kSegmentCount; ++s) {
    equations.AddTurn(s, 10.0 * Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.1, 0.0, 0.0));
  }
  equations.AddShape(1.0, ShapeVector::Ones());
  return equations;
}

// Against the dense inverse and the derivative by differences.
TEST(NormalEquations, CovarianceOfAPositionFollowsFromTheUnknowns) {
  const PosedSurface posed = PosedAt(RandomPose(8));
  NormalEquations equations = EquationsOf(posed);
  const NormalEquations::Matrix inverse =
      NormalEquations::Matrix(equations.matrix().selfadjointView<Eigen::Lower>()).inverse();
  ASSERT_TRUE(equations.Factor());
  const size_t i = posed.at_m().size() - 1;
  const SurfacePoint& point = Surface().points[i];
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, 3, kFitUnknowns> derivative;
  for (int k = 0; k < kFitUnknowns; ++k) {
    const FitStep step = kStep * FitStep::Unit(k);
    derivative.col(k) =
        (PosedAt(Moved(posed, step, 1.0)).at_m()[i] - PosedAt(Moved(posed, -step, 1.0)).at_m()[i]) /
        (2 * kStep);
  }
  const Eigen::Matrix3d expected = derivative * inverse * derivative.transpose();
  const Eigen::Matrix3d told =
      equations.CovarianceOf(posed, point.segment, posed.at_m()[i], point.place.by_shape_m);
  EXPECT_LT((told - expected).norm(), 1e-5 * expected.norm());
}

// The inverse of shape's block of the inverse; and the step of shape is that of the whole system.
TEST(NormalEquations, InformationOfTheShapeIsMarginal) {
  const PosedSurface posed = PosedAt(RandomPose(8));
  NormalEquations equations = EquationsOf(posed);
  const NormalEquations::Matrix inverse =
      NormalEquations::Matrix(equations.matrix().selfadjointView<Eigen::Lower>()).inverse();
  const ShapeVector step = -(inverse * equations.gradient()).tail<kShapeCount>();
  ASSERT_TRUE(equations.Factor());
  const ShapeMatrix covariance = inverse.bottomRightCorner<kShapeCount, kShapeCount>();
  const ShapeMatrix information = equations.ShapeInformation();
  EXPECT_LT((information * covariance - ShapeMatrix::Identity()).norm(), 1e-6);
  EXPECT_LT((information * step + equations.ShapeGradient()).norm(),
            1e-6 * equations.ShapeGradient().norm());
}

}  // namespace
}  // namespace ossa::recon
