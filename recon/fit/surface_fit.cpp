#include "recon/fit/surface_fit.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include "depth/base/statistics.h"
#include "recon/fit/fit_terms_internal.h"
#include "recon/fit/normal_equations.h"
#include "recon/fit/pose_from_joints.h"
#include "recon/fit/seen_person_internal.h"

namespace ossa::recon {
namespace {

// Constants: chosen by hand.

constexpr double kExplained_m = 0.03;    // a pixel is explained by a surface this near
constexpr double kFarAside_m = 0.06;     // a point farther aside than this explains no pixel
constexpr double kSeenThrough_m = 0.08;  // free space: the surface is this far behind the point
constexpr double kUnexplained_m = 1.0;   // residual of a pixel that nothing explains
constexpr double kUnknown_m2 = 1.0;      // variance of an unknown joint

// Standard deviation along each axis of the model error of each joint, metres: joint locations
// inside a body of rigid segments. On rendered people of train shapes in tight and in loose clothes
// (`ossa experiment fit`, train_shapes), chosen so that 68 and 95 % of the errors are within the
// stated ones.
constexpr JointArray<double> kModel_m = [] {
  constexpr double kArm_m[] = {0.006, 0.005, 0.006, 0.007};  // shoulder, elbow, wrist, hand
  constexpr double kLeg_m[] = {0.013, 0.020, 0.010, 0.003};  // hip, knee, ankle, foot
  JointArray<double> sigma_m;
  for (size_t j = 0; j < Index(Joint::kHead); ++j) sigma_m[j] = 0.009;
  sigma_m[Joint::kHead] = 0.007;
  for (size_t k = 0; k < 4; ++k) {
    sigma_m[Index(Joint::kShoulderLeft) + k] = sigma_m[Index(Joint::kShoulderRight) + k] =
        kArm_m[k];
    sigma_m[Index(Joint::kHipLeft) + k] = sigma_m[Index(Joint::kHipRight) + k] = kLeg_m[k];
  }
  return sigma_m;
}();

// Median of a joint's squared distance over its variance along an axis. By definition, of
// chi-square with three degrees of freedom.
constexpr double kMedianChi2 = 2.366;
// Smallest standard deviation of a start joint along an axis. By hand.
constexpr double kSurest_m = 0.005;

void CheckPositive(const char* name, double value) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw std::invalid_argument(
      fmt::format("SurfaceFitOptions.{} = {}, must be positive", name, value));
}

void CheckNotNegative(const char* name, double value) {
  if (value >= 0.0 && std::isfinite(value)) return;
  throw std::invalid_argument(
      fmt::format("SurfaceFitOptions.{} = {}, must not be negative", name, value));
}

bool IsUsable(const SurfaceFitInput& input) {
  const depth::Camera& camera = input.depth->camera;
  if (!(camera.fx > 0.0 && camera.fy > 0.0 && std::isfinite(camera.cx + camera.cy))) return false;
  for (const Eigen::Vector3d& joint_m : input.joints_m.position_m) {
    if (!joint_m.allFinite()) return false;
  }
  return true;
}

void CheckPixels(const char* name, std::span<const int32_t> pixels, const depth::DepthFrame& in) {
  const auto count = static_cast<int64_t>(in.pixel_count());
  for (const int32_t pixel : pixels) {
    if (pixel >= 0 && pixel < count) continue;
    throw std::invalid_argument(
        fmt::format("SurfaceFitInput.{}: {} of an image of {}", name, pixel, count));
  }
}

void CheckInput(const SurfaceFitInput& input) {
  if (input.depth == nullptr) throw std::invalid_argument("SurfaceFitInput.depth = null");
  if (input.parts.size() != input.samples.size() || input.sample_step < 1) {
    throw std::invalid_argument(fmt::format("SurfaceFitInput.parts: {} labels of {} pixels",
                                            input.parts.size(), input.samples.size()));
  }
  CheckPixels("pixels", input.pixels, *input.depth);
  CheckPixels("samples", input.samples, *input.depth);
}

}  // namespace

void SurfaceFitOptions::Check() const {
  CheckPositive("pixel_m", pixel_m);
  CheckPositive("robust_m", robust_m);
  CheckPositive("silhouette_m", silhouette_m);
  CheckPositive("silhouette_robust_m", silhouette_robust_m);
  CheckPositive("joint_m", joint_m);
  CheckPositive("joint_robust_m", joint_robust_m);
  CheckNotNegative("fitted_m", fitted_m);
  CheckNotNegative("doubt_residual_m", doubt_residual_m);
  CheckPositive("retry_joint_m", retry_joint_m);
  CheckPositive("retry_robust_m", retry_robust_m);
  CheckPositive("most_pixels", static_cast<double>(most_pixels));
}

struct SurfaceFitter::Impl {
  SurfaceFitOptions options;
  PosedSurface posed;
  SeenPerson seen;
  FacingPoints facing;
  NormalEquations equations;
  std::vector<double> distances_m;

  Impl(const BodySurface& surface, const SurfaceFitOptions& o) : options(o), posed(surface) {}

  void Pose(const SurfacePose& pose) {
    posed.PoseSegments(pose);
    posed.PosePoints();
    facing.Gather(posed);
  }
  void StartFrom(const SurfaceFitInput& input);
  // Adds all terms. Returns the pixel residual of AddPixels.
  double AddAll(const SurfaceFitInput& input, const SurfaceFitOptions& with);
  void Iterate(const SurfaceFitInput& input, const SurfaceFitOptions& with, int times);
  void Retry(const SurfaceFitInput& input, SurfaceFit& fit);
  void Judge(SurfaceFit& fit);
  void EstimateErrors(const SurfaceFitInput& input, SurfaceFit& fit);
  double StartVariance_m2(const SurfaceFitInput& input) const;
  Posture Blend(const SurfaceFitInput& input) const;
  double SeenThroughShare() const;
};

void SurfaceFitter::Impl::StartFrom(const SurfaceFitInput& input) {
  SurfacePose pose = PoseFromJoints(posed.surface(), input.joints_m);
  pose.shape = input.shape;
  posed.PoseSegments(pose);
  for (int i = 0; i < options.start_iterations; ++i) {
    equations.Clear();
    AddJoints(posed, input, options, equations);
    equations.Assemble(posed);
    AddPriors(posed, input, options, equations);
    posed.PoseSegments(Moved(posed, equations.Solve(options.damping), options.most_turn_rad));
  }
  Pose(posed.pose());
}

double SurfaceFitter::Impl::AddAll(const SurfaceFitInput& input, const SurfaceFitOptions& with) {
  double off = 0.0;
  equations.Clear();
  AddJoints(posed, input, with, equations);
  if (with.pixels) off = AddPixels(posed, facing, seen, with, equations);
  if (with.silhouette || with.free_space) AddSilhouette(posed, seen, with, equations);
  equations.Assemble(posed);
  AddPriors(posed, input, with, equations);
  return off;
}

void SurfaceFitter::Impl::Iterate(const SurfaceFitInput& input, const SurfaceFitOptions& with,
                                  int times) {
  for (int i = 0; i < times; ++i) {
    AddAll(input, with);
    Pose(Moved(posed, equations.Solve(with.damping), with.most_turn_rad));
  }
}

// Share of the points facing the camera that lie in free space.
double SurfaceFitter::Impl::SeenThroughShare() const {
  size_t seen_count = 0, through = 0;
  for (const uint32_t i : facing.points()) {
    const SeenPerson::SightAt at = seen.At(posed.at_m()[i]);
    using Sight = SeenPerson::Sight;
    if (at.sight == Sight::kNothing) continue;
    ++seen_count;
    const bool on_something = at.sight == Sight::kPerson || at.sight == Sight::kBeside;
    through += on_something && at.behind_m > kSeenThrough_m;
  }
  return seen_count == 0 ? 1.0 : static_cast<double>(through) / static_cast<double>(seen_count);
}

void SurfaceFitter::Impl::Judge(SurfaceFit& fit) {
  std::array<double, kSegmentCount> sum{};
  std::array<size_t, kSegmentCount> count{};
  distances_m.clear();
  size_t explained = 0;
  for (const SeenPerson::Pixel& pixel : seen.pixels()) {
    double distance_m = kUnexplained_m;
    const int found = facing.Nearest({pixel.at_m, 0, 0.0}, options);  // of any part
    if (found >= 0) {
      const auto i = static_cast<size_t>(found);
      const Eigen::Vector3d off_m = posed.at_m()[i] - pixel.at_m;
      const size_t s = posed.surface().points[i].segment;
      sum[s] += off_m.squaredNorm(), ++count[s];
      const double along_m = std::abs(off_m.dot(posed.normal()[i]));
      if (off_m.squaredNorm() < kFarAside_m * kFarAside_m) distance_m = along_m;
    }
    explained += distance_m < kExplained_m;
    distances_m.push_back(distance_m);
  }
  fit.median_residual_m = SelectRank(distances_m, distances_m.size() / 2);
  fit.explained = static_cast<double>(explained) / static_cast<double>(distances_m.size());
  fit.score = fit.explained - SeenThroughShare();
  for (size_t s = 0; s < kSegmentCount; ++s) {
    fit.residual_m[s].reset();
    if (count[s] > 0) fit.residual_m[s] = std::sqrt(sum[s] / static_cast<double>(count[s]));
  }
  fit.pose = posed.pose();
}

void SurfaceFitter::Impl::Retry(const SurfaceFitInput& input, SurfaceFit& fit) {
  SurfaceFitOptions bold = options;
  bold.joint_m = options.retry_joint_m;
  bold.robust_m = bold.silhouette_robust_m = options.retry_robust_m;
  const int as_many = fit.iterations;
  const int near = std::clamp(options.retry_near, 0, as_many);
  Iterate(input, bold, as_many - near);
  bold.robust_m = options.robust_m;
  bold.silhouette_robust_m = options.silhouette_robust_m;
  Iterate(input, bold, near);
  SurfaceFit second;
  Judge(second);
  if (second.score > fit.score + options.least_gain) {
    fit = second;
    fit.retried = true;
  } else {
    Pose(fit.pose);
  }
  fit.iterations = 2 * as_many;
}

// Estimates the errors of the finished fit. Pixel residuals above the expected ones increase all
// errors. Smaller ones do not reduce them, because pixels do not show most of a fit's errors.
void SurfaceFitter::Impl::EstimateErrors(const SurfaceFitInput& input, SurfaceFit& fit) {
  const double scale = std::max(1.0, AddAll(input, options));
  const bool solvable = equations.Factor();
  const BodySurface& surface = posed.surface();
  for (size_t j = 0; j < kJointCount; ++j) {
    fit.covariance_m2[j] = kUnknown_m2 * Eigen::Matrix3d::Identity();
    if (!solvable) continue;
    fit.covariance_m2[j] =
        kModel_m[j] * kModel_m[j] * Eigen::Matrix3d::Identity() +
        scale * equations.CovarianceOf(posed, surface.landmark_segment[j], posed.LandmarkAt(j),
                                       surface.landmark[j].by_shape_m);
  }
  if (!solvable) return;
  const double known = ComputeShapeWeight(input, options);
  const ShapeMatrix information = equations.ShapeInformation();
  fit.shape_information = (information - known * ShapeMatrix::Identity()) / scale;
  fit.shape_vote =
      (information * fit.pose.shape - equations.ShapeGradient() - known * input.shape) / scale;
}

// Variance along an axis of the start joints of confidence 1 in this image: the less compatible
// they are with a body, the larger.
double SurfaceFitter::Impl::StartVariance_m2(const SurfaceFitInput& input) const {
  std::array<double, kJointCount> off_m2{};
  size_t count = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!(input.confidence[j] && *input.confidence[j] > 0.0)) continue;
    const double off_m = (posed.LandmarkAt(j) - input.joints_m.position_m[j]).norm();
    const double sure_m = off_m / ComputeDoubt(input, options, j);
    off_m2[count++] = sure_m * sure_m;
  }
  if (count == 0) return options.joint_m * options.joint_m;
  const double middle_m2 = SelectRank(std::span(off_m2).first(count), count / 2);
  return std::max(kSurest_m * kSurest_m, middle_m2 / kMedianChi2);
}

Posture SurfaceFitter::Impl::Blend(const SurfaceFitInput& input) const {
  Posture blended = posed.Landmarks();
  const double start_m2 = StartVariance_m2(input);
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!input.confidence[j]) continue;
    const Eigen::Vector3d& start_m = input.joints_m.position_m[j];
    const double doubt = ComputeDoubt(input, options, j);
    const double pixel_m = std::max(0.0, start_m.z()) / input.depth->camera.fx;
    const double variance_m2 = start_m2 * doubt * doubt + pixel_m * pixel_m;
    const double share = variance_m2 / (variance_m2 + options.fitted_m * options.fitted_m);
    blended.position_m[j] = start_m + share * (blended.position_m[j] - start_m);
  }
  return blended;
}

SurfaceFitter::SurfaceFitter(const BodySurface& surface, const SurfaceFitOptions& options) {
  options.Check();
  impl_ = std::make_unique<Impl>(surface, options);
}
SurfaceFitter::~SurfaceFitter() = default;
SurfaceFitter::SurfaceFitter(SurfaceFitter&&) noexcept = default;
SurfaceFitter& SurfaceFitter::operator=(SurfaceFitter&&) noexcept = default;

std::optional<SurfaceFit> SurfaceFitter::Fit(const SurfaceFitInput& input) {
  CheckInput(input);
  if (!IsUsable(input) || input.pixels.empty()) return std::nullopt;
  Impl& m = *impl_;
  m.seen.Look(input, m.options);
  if (m.seen.pixels().size() < m.options.fewest_pixels) return std::nullopt;
  m.StartFrom(input);
  m.Iterate(input, m.options, m.options.iterations);
  SurfaceFit fit;
  m.Judge(fit);
  fit.iterations = m.options.start_iterations + m.options.iterations;
  if (m.options.retry && fit.score < m.options.poor_score) m.Retry(input, fit);
  m.EstimateErrors(input, fit);
  fit.joints_m = m.posed.Landmarks();
  fit.blended_m = m.Blend(input);
  for (size_t s = 0; s < kSegmentCount; ++s) {
    fit.camera_from_segment[s] = Eigen::Quaterniond(m.posed.camera_from(s));
  }
  fit.stature_m = m.posed.surface().Stature_m(fit.pose.shape);
  return fit;
}

}  // namespace ossa::recon
