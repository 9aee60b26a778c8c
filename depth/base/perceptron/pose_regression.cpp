#include "depth/base/perceptron/pose_regression.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ossa {

Eigen::Vector3d ComputeMiddle(std::span<const Eigen::Vector3d> points_m,
                              std::span<const double> weights, double least_weight) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  double whole = 0.0;
  for (size_t i = 0; i < points_m.size(); ++i) {
    const double weight = std::max(least_weight, weights[i]);
    sum_m += weight * points_m[i];
    whole += weight;
  }
  return sum_m / whole;
}

std::optional<ViewFrame> MakeViewFrame(const Eigen::Vector3d& middle_m) {
  constexpr double kLeastLevel = 1e-3;  // sine of the ray's angle to the vertical; by hand
  const Eigen::Vector3d z = middle_m.normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitY().cross(z);
  if (!(middle_m.z() > 0.0 && level.norm() > kLeastLevel)) return std::nullopt;
  const Eigen::Vector3d x = level.normalized();
  ViewFrame frame{{}, middle_m};
  frame.frame_from_camera << x.transpose(), z.cross(x).transpose(), z.transpose();
  return frame;
}

void MovePoints(const RowMatrix& outputs, std::span<const RegressedPoints> rows,
                const ViewFrame& frame, const OffsetScale& scale,
                std::span<Eigen::Vector3d> points_m) {
  constexpr double kLeast_m = 1e-9;  // derived: no division by 0
  const Eigen::Vector3d mirror(-1.0, 1.0, 1.0);
  const Eigen::Matrix3d camera_from_frame = frame.frame_from_camera.transpose();
  for (size_t r = 0; r < rows.size(); ++r) {
    for (size_t k = 0; k < rows[r].points.size(); ++k) {
      Eigen::Vector3d offset_m =
          scale.step_m *
          outputs.block<1, 3>(static_cast<Eigen::Index>(r), 3 * static_cast<Eigen::Index>(k))
              .transpose()
              .cast<double>();
      offset_m *= std::min(1.0, scale.farthest_m / std::max(offset_m.norm(), kLeast_m));
      if (rows[r].mirrored) offset_m = mirror.cwiseProduct(offset_m);
      points_m[rows[r].points[k]] += camera_from_frame * offset_m;
    }
  }
}

Eigen::RowVector3f EncodeOffset(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                                const ViewFrame& frame, const OffsetScale& scale) {
  const Eigen::Vector3d offset_m = frame.frame_from_camera * (to_m - from_m);
  return (offset_m / scale.step_m).cast<float>().transpose();
}

}  // namespace ossa
