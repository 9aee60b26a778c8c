#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>

#include "depth/base/perceptron/matrix_product.h"

namespace ossa {

// Cascaded pose regression (Dollar et al. 2010): each stage moves the points of a pose by offsets
// that networks regress from features of the previous pose. The forest's second stage and all
// stages of the refinement cascade at the depth image use this code; they differ in the features
// of their networks.

/// A coordinate frame centred on the person: offsets and features in it do not depend on the
/// person's position in the image.
struct ViewFrame {
  Eigen::Matrix3d frame_from_camera = Eigen::Matrix3d::Identity();  // z along the ray, x level
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();               // origin, camera space
};

/// Weighted mean of the points; each weight is at least `least_weight`.
Eigen::Vector3d ComputeMiddle(std::span<const Eigen::Vector3d> points_m,
                              std::span<const double> weights, double least_weight);
/// The frame at a point in camera space; none behind, exactly above or exactly below the camera.
std::optional<ViewFrame> MakeViewFrame(const Eigen::Vector3d& middle_m);

/// Scale of a network's outputs.
struct OffsetScale {
  double step_m = 0.1;  // offset of an output of 1; part of every shipped model
  /// Upper bound of a point's offset in one stage.
  double farthest_m = std::numeric_limits<double>::infinity();
};

/// Points moved by a row of outputs: the k-th by outputs 3k to 3k + 2.
struct RegressedPoints {
  std::span<const size_t> points;
  bool mirrored = false;  // features are of the mirror image, left and right exchanged
};

/// Moves points (camera space) by rows of network outputs.
void MovePoints(const RowMatrix& outputs, std::span<const RegressedPoints> rows,
                const ViewFrame& frame, const OffsetScale& scale,
                std::span<Eigen::Vector3d> points_m);

/// Runs one network of a stage (Perceptron or QuantisedPerceptron) on rows of features, and moves
/// the points. Returns the outputs, which may contain more than the offsets.
template <typename Network>
RowMatrix Regress(const Network& network, const RowMatrix& features,
                  std::span<const RegressedPoints> rows, const ViewFrame& frame,
                  const OffsetScale& scale, std::span<Eigen::Vector3d> points_m) {
  RowMatrix outputs = network.Run(features);
  MovePoints(outputs, rows, frame, scale, points_m);
  return outputs;
}

/// Training target for a point at `from_m` whose true position is `to_m`, camera space.
Eigen::RowVector3f EncodeOffset(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                                const ViewFrame& frame, const OffsetScale& scale);

}  // namespace ossa
