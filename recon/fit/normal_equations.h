#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/fit/posed_surface.h"

namespace ossa::recon {

/// How the surface moves as one: turn of the pelvis about the camera's origin and shift (6), turn
/// of each other segment about its joint (3), all in camera axes; change of shape.
inline constexpr int kFitUnknowns =
    6 + 3 * (static_cast<int>(kSegmentCount) - 1) + kShapeCount;  // by definition
using FitStep = Eigen::Matrix<double, kFitUnknowns, 1>;

/// A residual as seen from the segment that carries it: derivative by a turn of the segment about
/// the camera's origin, by its shift, by shape.
inline constexpr int kRowSize = 6 + kShapeCount;
using FitRow = Eigen::Matrix<double, kRowSize, 1>;

/// The row of a residual along' (at - fixed point), `along` held fixed: of a place `at_m` that the
/// segment carries and that moves on it with shape by `by_shape_m` (axes of the rest pose).
FitRow RowOfPlace(const PosedSurface& posed, size_t segment, const Eigen::Vector3d& at_m,
                  const Eigen::Vector3d& along, const ShapeBasis& by_shape_m);

/// Weighted least squares on the tree of segments. Each residual depends on the motion of one
/// segment, so rows are summed up segment by segment and spread over the segment's ancestors once,
/// as composite inertias are (Featherstone 2008, algorithm 6.2): what a residual costs does not
/// depend on how long its chain is.
class NormalEquations {
 public:
  void Clear();
  /// Adds weight * (row' x + residual)^2 / 2.
  void Add(size_t segment, const FitRow& row, double residual, double weight);
  /// Sums the segments up to the whole: no Add after it, until Clear.
  void Assemble(const PosedSurface& posed);
  /// Adds (x - to)' information (x - to) / 2 of the segment's own turn; segment > 0.
  void AddTurn(size_t segment, const Eigen::Matrix3d& information, const Eigen::Vector3d& to_rad);
  void AddShape(double weight, const ShapeVector& to);
  /// The step that minimises the sum; zero where it cannot be told.
  FitStep Solve(double damping);

  /// Factors the matrix as it is, for what is told below; false where the system cannot be solved.
  bool Factor();
  /// Of a place as in RowOfPlace, camera axes: J inverse(matrix) J'.
  Eigen::Matrix3d CovarianceOf(const PosedSurface& posed, size_t segment,
                               const Eigen::Vector3d& at_m, const ShapeBasis& by_shape_m) const;
  /// Of shape whatever the pose is (the Schur complement), and the gradient there.
  ShapeMatrix ShapeInformation() const;
  ShapeVector ShapeGradient() const;

  using Matrix = Eigen::Matrix<double, kFitUnknowns, kFitUnknowns>;
  const Matrix& matrix() const { return matrix_; }  // its lower triangle
  const FitStep& gradient() const { return gradient_; }

 private:
  std::array<Eigen::Matrix<double, kRowSize, kRowSize>, kSegmentCount> by_segment_;
  std::array<FitRow, kSegmentCount> gradient_by_segment_;
  Matrix matrix_, factor_;
  FitStep gradient_;
};

/// The pose after a step; no joint turns by more than `most_rad`.
SurfacePose Moved(const PosedSurface& posed, const FitStep& step, double most_rad);

}  // namespace ossa::recon
