#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>

#include "depth/base/perceptron/matrix_product.h"

namespace ossa {

/// Cascaded pose regression (Dollar et al. 2010): a stage moves the points of a pose by offsets
/// that networks regress from features of the pose before it. The forest's second stage of joints
/// and every stage of the refinement cascade at the depth image move their points by this code;
/// they differ in the features that their networks read.

/// Axes that stand in the person: wherever in the image somebody stands, offsets and features in
/// them are the same.
struct ViewFrame {
  Eigen::Matrix3d frame_from_camera = Eigen::Matrix3d::Identity();  // z along the ray, x level
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();               // origin, camera space
};

/// The mean of the points, each of its weight, but at least `least_weight`.
Eigen::Vector3d ComputeMiddle(std::span<const Eigen::Vector3d> points_m,
                              std::span<const double> weights, double least_weight);
/// The axes at a place in camera space; nothing behind, right above or right below the camera.
std::optional<ViewFrame> MakeViewFrame(const Eigen::Vector3d& middle_m);

/// What a network's outputs mean.
struct OffsetScale {
  double step_m = 0.1;  // an output of 1; part of every shipped model
  /// Whatever a network says, a point goes no farther in one stage.
  double farthest_m = std::numeric_limits<double>::infinity();
};

/// Points that a row of a network's outputs moves: the k-th by outputs 3k to 3k + 2.
struct RegressedPoints {
  std::span<const size_t> points;
  bool mirrored = false;  // the features were those of the mirror image, left and right exchanged
};

/// Moves points (camera space) by rows of outputs.
void MovePoints(const RowMatrix& outputs, std::span<const RegressedPoints> rows,
                const ViewFrame& frame, const OffsetScale& scale,
                std::span<Eigen::Vector3d> points_m);

/// Runs one network of a stage (Perceptron or QuantisedPerceptron) on rows of features, and moves
/// the points. Returns the outputs, for what may stand behind the offsets.
template <typename Network>
RowMatrix Regress(const Network& network, const RowMatrix& features,
                  std::span<const RegressedPoints> rows, const ViewFrame& frame,
                  const OffsetScale& scale, std::span<Eigen::Vector3d> points_m) {
  RowMatrix outputs = network.Run(features);
  MovePoints(outputs, rows, frame, scale, points_m);
  return outputs;
}

/// What a network is to say of a point that is at `from_m` and should be at `to_m`, camera space.
Eigen::RowVector3f EncodeOffset(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                                const ViewFrame& frame, const OffsetScale& scale);

}  // namespace ossa
