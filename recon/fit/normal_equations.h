#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/fit/posed_surface.h"

namespace ossa::recon {

/// The unknowns: rotation of the pelvis about the camera's origin and translation (6), rotation of
/// each other segment about its joint (3 each), all in camera axes; change of shape.
inline constexpr int kFitUnknowns =
    6 + 3 * (static_cast<int>(kSegmentCount) - 1) + kShapeCount;  // by definition
using FitStep = Eigen::Matrix<double, kFitUnknowns, 1>;

/// A residual's derivative with respect to its segment's motion: rotation of the segment about the
/// camera's origin, translation, and shape.
inline constexpr int kRowSize = 6 + kShapeCount;
using FitRow = Eigen::Matrix<double, kRowSize, 1>;

/// The row of the residual along' (at - fixed point), with `along` held constant, for a point
/// `at_m` on the segment that moves by `by_shape_m` with shape (axes of the rest pose).
FitRow RowOfPlace(const PosedSurface& posed, size_t segment, const Eigen::Vector3d& at_m,
                  const Eigen::Vector3d& along, const ShapeBasis& by_shape_m);

/// Weighted least squares on the kinematic tree. Each residual depends on the motion of one
/// segment, so rows are accumulated per segment and propagated to the ancestors once, like
/// composite inertias (Featherstone 2008, algorithm 6.2): the cost of a residual does not depend on
/// the length of its chain.
class NormalEquations {
 public:
  void Clear();
  /// Adds weight * (row' x + residual)^2 / 2.
  void Add(size_t segment, const FitRow& row, double residual, double weight);
  /// Sums the segments up to the full system: no Add after it, until Clear.
  void Assemble(const PosedSurface& posed);
  /// Adds (x - to)' information (x - to) / 2 for the segment's own rotation x; segment > 0.
  void AddTurn(size_t segment, const Eigen::Matrix3d& information, const Eigen::Vector3d& to_rad);
  void AddShape(double weight, const ShapeVector& to);
  /// The step that minimises the sum; zero if the system is singular.
  FitStep Solve(double damping);

  /// Factorises the undamped matrix for the functions below; false if it is singular.
  bool Factor();
  /// Covariance of a point as in RowOfPlace, camera axes: J inverse(matrix) J'.
  Eigen::Matrix3d CovarianceOf(const PosedSurface& posed, size_t segment,
                               const Eigen::Vector3d& at_m, const ShapeBasis& by_shape_m) const;
  /// Information of shape with the pose marginalised out (Schur complement), and the corresponding
  /// gradient.
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

/// The pose after a step; no joint rotates by more than `most_rad`.
SurfacePose Moved(const PosedSurface& posed, const FitStep& step, double most_rad);

}  // namespace ossa::recon
