#include "recon/fit/normal_equations.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace ossa::recon {
namespace {

constexpr int kShapeAt = kFitUnknowns - kShapeCount;

// Index of a segment's own rotation among the unknowns; segment > 0.
constexpr int TurnAt(size_t segment) { return 6 + 3 * (static_cast<int>(segment) - 1); }

// Rotations about a joint as rigid motions about the origin: rotation and translation.
Eigen::Matrix<double, 6, 3> MotionOfTurnAbout(const Eigen::Vector3d& joint_m) {
  Eigen::Matrix<double, 6, 3> motion;
  motion.topRows<3>().setIdentity();
  motion.bottomRows<3>() << 0.0, -joint_m.z(), joint_m.y(),  //
      joint_m.z(), 0.0, -joint_m.x(),                        //
      -joint_m.y(), joint_m.x(), 0.0;
  return motion;
}

}  // namespace

FitRow RowOfPlace(const PosedSurface& posed, size_t segment, const Eigen::Vector3d& at_m,
                  const Eigen::Vector3d& along, const ShapeBasis& by_shape_m) {
  FitRow row;
  row.head<3>() = at_m.cross(along);
  row.segment<3>(3) = along;
  row.tail<kShapeCount>().noalias() =
      by_shape_m.transpose() * (posed.camera_from(segment).transpose() * along) +
      posed.joint_by_shape_m(segment).transpose() * along;
  return row;
}

void NormalEquations::Clear() {
  for (auto& matrix : by_segment_) matrix.setZero();
  for (auto& gradient : gradient_by_segment_) gradient.setZero();
}

void NormalEquations::Add(size_t segment, const FitRow& row, double residual, double weight) {
  const FitRow weighted = weight * row;
  by_segment_[segment].noalias() += weighted * row.transpose();
  gradient_by_segment_[segment] += residual * weighted;
}

void NormalEquations::Assemble(const PosedSurface& posed) {
  for (size_t s = kSegmentCount - 1; s > 0; --s) {
    by_segment_[ParentSegment(s)] += by_segment_[s];
    gradient_by_segment_[ParentSegment(s)] += gradient_by_segment_[s];
  }
  const auto& all = by_segment_[0];
  matrix_.setZero();
  matrix_.topLeftCorner<6, 6>() = all.topLeftCorner<6, 6>();
  matrix_.block<kShapeCount, 6>(kShapeAt, 0) = all.bottomLeftCorner<kShapeCount, 6>();
  matrix_.bottomRightCorner<kShapeCount, kShapeCount>() =
      all.bottomRightCorner<kShapeCount, kShapeCount>();
  gradient_.head<6>() = gradient_by_segment_[0].head<6>();
  gradient_.tail<kShapeCount>() = gradient_by_segment_[0].tail<kShapeCount>();
  for (size_t s = 1; s < kSegmentCount; ++s) {
    const int at = TurnAt(s);
    const Eigen::Matrix<double, 6, 3> motion = MotionOfTurnAbout(posed.joint_m(s));
    const Eigen::Matrix<double, 3, kRowSize> rows =
        motion.transpose() * by_segment_[s].topRows<6>();
    gradient_.segment<3>(at) = motion.transpose() * gradient_by_segment_[s].head<6>();
    matrix_.block<3, 6>(at, 0) = rows.leftCols<6>();
    matrix_.block<3, 3>(at, at) = rows.leftCols<6>() * motion;
    for (size_t a = ParentSegment(s); a > 0; a = ParentSegment(a)) {
      matrix_.block<3, 3>(at, TurnAt(a)) = rows.leftCols<6>() * MotionOfTurnAbout(posed.joint_m(a));
    }
    matrix_.block<kShapeCount, 3>(kShapeAt, at) = rows.rightCols<kShapeCount>().transpose();
  }
}

void NormalEquations::AddTurn(size_t segment, const Eigen::Matrix3d& information,
                              const Eigen::Vector3d& to_rad) {
  const int at = TurnAt(segment);
  matrix_.block<3, 3>(at, at) += information;
  gradient_.segment<3>(at) -= information * to_rad;
}

void NormalEquations::AddShape(double weight, const ShapeVector& to) {
  matrix_.diagonal().tail<kShapeCount>().array() += weight;
  gradient_.tail<kShapeCount>() -= weight * to;
}

FitStep NormalEquations::Solve(double damping) {
  constexpr double kLeast = 1e-6;  // by hand, a weight: keeps unobserved unknowns solvable
  factor_ = matrix_;
  factor_.diagonal() *= 1.0 + damping;
  factor_.diagonal().array() += kLeast;
  const Eigen::LLT<Eigen::Ref<Matrix>> solver(factor_);
  if (solver.info() != Eigen::Success) return FitStep::Zero();
  FitStep step = -gradient_;
  solver.solveInPlace(step);
  return step.allFinite() ? step : FitStep::Zero();
}

bool NormalEquations::Factor() {
  factor_ = matrix_;
  return Eigen::LLT<Eigen::Ref<Matrix>>(factor_).info() == Eigen::Success;
}

Eigen::Matrix3d NormalEquations::CovarianceOf(const PosedSurface& posed, size_t segment,
                                              const Eigen::Vector3d& at_m,
                                              const ShapeBasis& by_shape_m) const {
  Eigen::Matrix<double, kFitUnknowns, 3> derivative;
  derivative.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    const FitRow row = RowOfPlace(posed, segment, at_m, Eigen::Vector3d::Unit(axis), by_shape_m);
    derivative.col(axis).head<6>() = row.head<6>();
    derivative.col(axis).tail<kShapeCount>() = row.tail<kShapeCount>();
  }
  for (size_t s = segment; s > 0; s = ParentSegment(s)) {
    derivative.middleRows<3>(TurnAt(s)) =
        MotionOfTurnAbout(posed.joint_m(s)).transpose() * derivative.topRows<6>();
  }
  factor_.triangularView<Eigen::Lower>().solveInPlace(derivative);
  return derivative.transpose() * derivative;
}

ShapeMatrix NormalEquations::ShapeInformation() const {
  const ShapeMatrix lower =
      factor_.bottomRightCorner<kShapeCount, kShapeCount>().triangularView<Eigen::Lower>();
  return lower * lower.transpose();
}

ShapeVector NormalEquations::ShapeGradient() const {
  FitStep reduced = gradient_;
  factor_.triangularView<Eigen::Lower>().solveInPlace(reduced);
  return factor_.bottomRightCorner<kShapeCount, kShapeCount>().triangularView<Eigen::Lower>() *
         reduced.tail<kShapeCount>();
}

SurfacePose Moved(const PosedSurface& posed, const FitStep& step, double most_rad) {
  // Standard deviations of shape; by hand. The first component is size: people from 1.1 to 2.1 m
  // are more spread out than a normal distribution.
  constexpr double kFarthest = 3.0, kFarthestSize = 5.0;
  SurfacePose pose = posed.pose();
  const Eigen::Matrix3d turn = ToRotation(step.head<3>());
  pose.pelvis_m = turn * pose.pelvis_m + step.segment<3>(3);
  pose.parent_from_segment[0] = turn * pose.parent_from_segment[0];
  for (size_t s = 1; s < kSegmentCount; ++s) {
    Eigen::Vector3d own = step.segment<3>(TurnAt(s));
    if (own.norm() > most_rad) own *= most_rad / own.norm();
    own = posed.camera_from(ParentSegment(s)).transpose() * own;
    pose.parent_from_segment[s] = ToRotation(own) * pose.parent_from_segment[s];
  }
  pose.shape += step.tail<kShapeCount>();
  ShapeVector farthest = ShapeVector::Constant(kFarthest);
  farthest[0] = kFarthestSize;
  pose.shape = pose.shape.cwiseMax(-farthest).cwiseMin(farthest);
  return pose;
}

}  // namespace ossa::recon
