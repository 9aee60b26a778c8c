#include "recon/refine/free_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace ossa::recon {
namespace {

// By hand, the radius of a joint: noise at a silhouette must not put a limb into free space.
constexpr double kBreadth_m = 0.02;

// The image around one joint, as depth differences from it.
class Surroundings {
 public:
  Surroundings(const Eigen::Vector3d& joint_in_camera, const depth::DepthFrame& depth)
      : view_(depth.view()),
        z_m_(joint_in_camera.z()),
        centre_(depth::Project(depth.camera, joint_in_camera)),
        pixels_per_m_(depth.camera.fx / joint_in_camera.z()) {}

  // Depth of the surface minus depth of the joint, metres, at offset `off_m` from the joint; none
  // without a reading.
  std::optional<double> GapAt(const Eigen::Vector2d& off_m) const {
    const Eigen::Vector2d at = centre_ + pixels_per_m_ * off_m;
    if (!(at.cwiseAbs().maxCoeff() < 1e5)) return std::nullopt;
    const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
    if (!view_.Contains(u, v) || view_.at(u, v) == 0) return std::nullopt;
    return depth::MetresFromMillimetres(view_.at(u, v)) - z_m_;
  }

  Eigen::Vector2d PixelAt(const Eigen::Vector2d& off_m) const {
    return centre_ + pixels_per_m_ * off_m;
  }

  // The size of a pixel, but at least a centimetre.
  double step_m() const { return std::max(0.01, 1.0 / pixels_per_m_); }

 private:
  depth::DepthView view_;
  double z_m_;
  Eigen::Vector2d centre_;
  double pixels_per_m_;
};

bool Hides(const std::optional<double>& gap_m, const FreeSpaceOptions& options) {
  return gap_m && *gap_m <= options.before_m;
}

// Displacement from the joint: perpendicular to the line of sight, and backwards along it.
struct Cover {
  Eigen::Vector2d across_m = Eigen::Vector2d::Zero();
  double behind_m = 0.0;
  double way_m = 1e9;
};

// How far a joint must move back to be behind a surface with this gap.
double WayBehind(double gap_m, const FreeSpaceOptions& options) {
  return std::max(0.0, gap_m + options.skin_m);
}

// The nearest position that hides the joint, searched on circles around it: beside it, or farther
// back.
Cover NearestCover(const Surroundings& around, const FreeSpaceOptions& options) {
  const double step_m = around.step_m();
  Cover best;
  for (double radius_m = 0.0; radius_m <= std::min(options.reach_m, best.way_m);
       radius_m += step_m) {
    const int places =
        std::max(1, static_cast<int>(std::ceil(2.0 * std::numbers::pi * radius_m / step_m)));
    for (int k = 0; k < places; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / places;
      const Eigen::Vector2d off_m = radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const auto gap_m = around.GapAt(off_m);
      if (!gap_m) continue;
      const double behind_m = WayBehind(*gap_m, options);
      const double way_m = std::sqrt(radius_m * radius_m + behind_m * behind_m);
      if (way_m < best.way_m) best = {off_m, behind_m, way_m};
    }
  }
  return best;
}

}  // namespace

bool IsInFreeSpace(const Eigen::Vector3d& joint_in_camera, const depth::DepthFrame& depth,
                   const FreeSpaceOptions& options) {
  if (!joint_in_camera.allFinite() || joint_in_camera.z() < 0.1) return false;
  const Surroundings around(joint_in_camera, depth);
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, std::pair{-1.0, 0.0}, std::pair{1.0, 0.0},
                             std::pair{0.0, -1.0}, std::pair{0.0, 1.0}}) {
    const auto gap_m = around.GapAt(kBreadth_m * Eigen::Vector2d(x, y));
    if (!gap_m || Hides(gap_m, options)) return false;
  }
  return true;
}

Eigen::Vector3d MoveOutOfFreeSpace(const Eigen::Vector3d& joint_in_camera,
                                   const depth::DepthFrame& depth,
                                   const FreeSpaceOptions& options) {
  if (!IsInFreeSpace(joint_in_camera, depth, options)) return joint_in_camera;
  const Surroundings around(joint_in_camera, depth);
  Cover cover = NearestCover(around, options);
  if (cover.way_m > options.reach_m) return joint_in_camera;
  if (const double across_m = cover.across_m.norm(); across_m > 0.0) {
    const Eigen::Vector2d within_m = cover.across_m * (1.0 + options.inwards_m / across_m);
    const auto gap_m = around.GapAt(within_m);
    // Not behind thin occluders.
    if (gap_m && WayBehind(*gap_m, options) <= cover.behind_m + options.before_m)
      cover = {within_m, WayBehind(*gap_m, options), cover.way_m};
  }
  const double z_m = joint_in_camera.z() + cover.behind_m;
  const Eigen::Vector2d pixel = around.PixelAt(cover.across_m);
  return depth::BackProject(depth.camera, pixel.x(), pixel.y(), 1e3 * z_m);
}

}  // namespace ossa::recon
