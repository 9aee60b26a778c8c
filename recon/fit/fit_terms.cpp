#include <algorithm>
#include <cmath>

#include "recon/fit/fit_terms_internal.h"

namespace ossa::recon {
namespace {

// Geman and McClure 1987: the weight of a residual with this square.
double RobustWeight(double squared, double scale) {
  const double share = scale * scale / (scale * scale + squared);
  return share * share;
}

// Two unit vectors perpendicular to `unit` and to each other.
std::array<Eigen::Vector3d, 2> Across(const Eigen::Vector3d& unit) {
  const Eigen::Vector3d a = unit.unitOrthogonal();
  return {a, unit.cross(a)};
}

}  // namespace

double AddPixels(const PosedSurface& posed, const FacingPoints& facing, const SeenPerson& seen,
                 const SurfaceFitOptions& options, NormalEquations& equations) {
  double squares = 0.0, shares = 0.0;
  for (const SeenPerson::Pixel& pixel : seen.pixels()) {
    const int found = facing.Nearest(pixel, options);
    if (found < 0) return 0.0;
    const auto i = static_cast<size_t>(found);
    const SurfacePoint& point = posed.surface().points[i];
    const Eigen::Vector3d &at_m = posed.at_m()[i], &normal = posed.normal()[i];
    const Eigen::Vector3d off_m = at_m - pixel.at_m;
    const double trust = RobustWeight(off_m.squaredNorm(), options.robust_m);
    const double weight = seen.pixel_share() * pixel.weight * trust;
    const double along_m = off_m.dot(normal);
    squares += trust * pixel.weight * along_m * along_m;
    shares += trust;
    const auto add = [&](const Eigen::Vector3d& along, double share) {
      equations.Add(point.segment,
                    RowOfPlace(posed, point.segment, at_m, along, point.place.by_shape_m),
                    off_m.dot(along), share * weight);
    };
    add(normal, 1.0 + options.along_share);
    for (const Eigen::Vector3d& along : Across(normal)) add(along, options.along_share);
  }
  return shares > 0.0 ? squares / shares : 0.0;
}

void AddSilhouette(const PosedSurface& posed, const SeenPerson& seen,
                   const SurfaceFitOptions& options, NormalEquations& equations) {
  using Sight = SeenPerson::Sight;
  const auto& points = posed.surface().points;
  const double share =
      static_cast<double>(options.most_pixels) / static_cast<double>(points.size());
  const double full = share / (options.silhouette_m * options.silhouette_m);
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& at_m = posed.at_m()[i];
    const SeenPerson::SightAt at = seen.At(at_m);
    Eigen::Vector3d along = Eigen::Vector3d::UnitZ();
    double off_m = 0.0, weight = full;
    if (at.sight == Sight::kPerson) {
      if (!options.free_space || !posed.FacesCamera(i) || at.behind_m < options.free_space_m) {
        continue;
      }
      off_m = 0.5 * options.free_space_m - at.behind_m;
      weight *= options.free_space_share;
    } else if (at.sight == Sight::kBeside || at.sight == Sight::kNoReading) {
      off_m = -at.way_m.norm();
      if (!options.silhouette || off_m == 0.0) continue;
      along = at.way_m / -off_m;
      if (at.sight == Sight::kNoReading) weight *= options.no_reading_share;
    } else {
      continue;
    }
    const size_t s = points[i].segment;
    equations.Add(s, RowOfPlace(posed, s, at_m, along, points[i].place.by_shape_m), off_m,
                  weight * RobustWeight(off_m * off_m, options.silhouette_robust_m));
  }
}

double ComputeDoubt(const SurfaceFitInput& input, const SurfaceFitOptions& options, size_t joint) {
  const double confidence = std::clamp(input.confidence[joint].value_or(0.0), 0.0, 1.0);
  return 1.0 + options.doubt * (1.0 - confidence);
}

double ComputeJointVariance_m2(const SurfaceFitInput& input, const SurfaceFitOptions& options,
                               size_t joint) {
  const double sigma_m = options.joint_m * ComputeDoubt(input, options, joint);
  const double away_m = std::max(0.0, input.joints_m.position_m[joint].z());
  const double size_m = options.footprint * away_m / input.depth->camera.fx;
  return sigma_m * sigma_m + size_m * size_m;
}

void AddJoints(const PosedSurface& posed, const SurfaceFitInput& input,
               const SurfaceFitOptions& options, NormalEquations& equations) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!input.confidence[j]) continue;
    const size_t s = posed.surface().landmark_segment[j];
    const Eigen::Vector3d at_m = posed.LandmarkAt(j);
    const Eigen::Vector3d off_m = at_m - input.joints_m.position_m[j];
    const double weight = RobustWeight(off_m.squaredNorm(), options.joint_robust_m) /
                          ComputeJointVariance_m2(input, options, j);
    const ShapeBasis& by_shape_m = posed.surface().landmark[j].by_shape_m;
    for (int axis = 0; axis < 3; ++axis) {
      equations.Add(s, RowOfPlace(posed, s, at_m, Eigen::Vector3d::Unit(axis), by_shape_m),
                    off_m[axis], weight);
    }
  }
}

double ComputeShapeWeight(const SurfaceFitInput& input, const SurfaceFitOptions& options) {
  constexpr double kMostFrames = 20.0;  // by hand, frames: people may be confused for a while
  const double frames = std::min(kMostFrames, static_cast<double>(input.shape_frames));
  return options.shape_weight * (1.0 + frames);
}

void AddPriors(const PosedSurface& posed, const SurfaceFitInput& input,
               const SurfaceFitOptions& options, NormalEquations& equations) {
  const BodySurface& surface = posed.surface();
  for (size_t s = 1; s < kSegmentCount; ++s) {
    // A small rotation in camera axes changes the rotation vector by about the same rotation in the
    // parent's axes.
    const Eigen::Matrix3d& camera_from = posed.camera_from(ParentSegment(s));
    const Eigen::Vector3d to_rad =
        surface.turn_mean[s] - ToRotationVector(posed.pose().parent_from_segment[s]);
    equations.AddTurn(
        s,
        options.turn_weight * camera_from * surface.turn_information[s] * camera_from.transpose(),
        camera_from * to_rad);
  }
  equations.AddShape(ComputeShapeWeight(input, options), input.shape - posed.pose().shape);
}

}  // namespace ossa::recon
