#include "tests/recon/fit/exact_fit.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>
#include <array>

namespace ossa::recon {
namespace {

using Unknowns = std::array<double, kFitUnknowns>;

double GemanMcClure(double squared, double scale) {
  return std::pow(scale * scale / (scale * scale + squared), 2);
}

template <typename T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

template <typename T>
Mat3<T> Rotation(const Vec3<T>& turn) {
  Mat3<T> rotation;
  ceres::AngleAxisToRotationMatrix(turn.data(), rotation.data());
  return rotation;
}

/// The body after a motion, in the number type of Ceres' automatic differentiation.
template <typename T>
struct MovedBody {
  std::array<Mat3<T>, kSegmentCount> parent_from, camera_from;
  std::array<Vec3<T>, kSegmentCount> joint_m;
  Eigen::Matrix<T, kShapeCount, 1> shape;

  MovedBody(const SurfacePose& from, const T* x) {
    const BodySurface& body = Surface();
    shape = from.shape.cast<T>() +
            Eigen::Map<const Eigen::Matrix<T, kShapeCount, 1>>(x + kFitUnknowns - kShapeCount);
    const Mat3<T> turn = Rotation<T>(Eigen::Map<const Vec3<T>>(x));
    parent_from[0] = camera_from[0] = turn * from.parent_from_segment[0].cast<T>();
    joint_m[0] = turn * from.pelvis_m.cast<T>() + Eigen::Map<const Vec3<T>>(x + 3);
    std::array<Eigen::Matrix3d, kSegmentCount> before;
    before[0] = from.parent_from_segment[0];
    for (size_t s = 1; s < kSegmentCount; ++s) {
      const size_t p = ParentSegment(s);
      before[s] = before[p] * from.parent_from_segment[s];
      const Vec3<T> own =
          before[p].transpose().cast<T>() * Eigen::Map<const Vec3<T>>(x + 3 + 3 * s);
      parent_from[s] = Rotation<T>(own) * from.parent_from_segment[s].cast<T>();
      camera_from[s] = camera_from[p] * parent_from[s];
      joint_m[s] = joint_m[p] + camera_from[p] * At(body.joint[s]);
    }
  }
  Vec3<T> At(const ShapedPlace& place) const {
    return place.mean_m.cast<T>() + place.by_shape_m.cast<T>() * shape;
  }
};

struct Residuals {
  const ExactProblem& problem;
  bool priors() const { return problem.turn_weight > 0.0; }
  int Count() const {
    return static_cast<int>(3 * problem.places.size() +
                            (priors() ? 3 * (kSegmentCount - 1) + kShapeCount : 0));
  }
  template <typename T>
  bool operator()(const T* x, T* out) const {
    const MovedBody<T> body(problem.pose, x);
    for (const DrawnPlace& drawn : problem.places) {
      const Vec3<T> at_m =
          body.joint_m[drawn.segment] + body.camera_from[drawn.segment] * body.At(drawn.place);
      Eigen::Map<Vec3<T>>{out} = drawn.root.cast<T>() * (at_m - drawn.to_m.cast<T>());
      out += 3;
    }
    if (priors()) AddPriors(body, out);
    return true;
  }
  template <typename T>
  void AddPriors(const MovedBody<T>& body, T* out) const {
    for (size_t s = 1; s < kSegmentCount; ++s, out += 3) {
      Vec3<T> turn;
      ceres::RotationMatrixToAngleAxis(body.parent_from[s].data(), turn.data());
      const Eigen::LLT<Eigen::Matrix3d> root(problem.turn_weight * Surface().turn_information[s]);
      Eigen::Map<Vec3<T>>{out} =
          Eigen::Matrix3d(root.matrixU()).cast<T>() * (turn - Surface().turn_mean[s].cast<T>());
    }
    for (int k = 0; k < kShapeCount; ++k) {
      out[k] = std::sqrt(problem.shape_weight) * (body.shape[k] - problem.known_shape[k]);
    }
  }
};

void AddTo(ceres::Problem& ceres_problem, const ExactProblem& problem, Unknowns& x) {
  auto* residuals = new Residuals{problem};
  using Cost = ceres::AutoDiffCostFunction<Residuals, ceres::DYNAMIC, kFitUnknowns>;
  ceres_problem.AddResidualBlock(new Cost(residuals, residuals->Count()), nullptr, x.data());
}

void DrawPixels(const PosedSurface& posed, const SeenPerson& seen, const SurfaceFitOptions& options,
                std::vector<DrawnPlace>& places) {
  FacingPoints facing;
  facing.Gather(posed);
  for (const SeenPerson::Pixel& pixel : seen.pixels()) {
    const auto i = static_cast<size_t>(facing.Nearest(pixel, options));
    const SurfacePoint& point = Surface().points[i];
    const double off2 = (posed.at_m()[i] - pixel.at_m).squaredNorm();
    const double weight = seen.pixel_share() * pixel.weight * GemanMcClure(off2, options.robust_m);
    const Eigen::Vector3d& normal = posed.normal()[i];
    const Eigen::Matrix3d information =
        weight * (normal * normal.transpose() + options.along_share * Eigen::Matrix3d::Identity());
    places.push_back({point.segment, point.place, pixel.at_m,
                      Eigen::LLT<Eigen::Matrix3d>(information).matrixU()});
  }
}

void DrawIntoSilhouette(const PosedSurface& posed, const SeenPerson& seen,
                        const SurfaceFitOptions& options, std::vector<DrawnPlace>& places) {
  const size_t count = Surface().points.size();
  for (size_t i = 0; i < count; ++i) {
    const SeenPerson::SightAt at = seen.At(posed.at_m()[i]);
    const bool beside = at.sight == SeenPerson::Sight::kBeside;
    if (!beside && at.sight != SeenPerson::Sight::kNoReading) continue;
    if (at.way_m.norm() == 0.0) continue;
    const double weight = static_cast<double>(options.most_pixels) / static_cast<double>(count) /
                          (options.silhouette_m * options.silhouette_m) *
                          (beside ? 1.0 : options.no_reading_share) *
                          GemanMcClure(at.way_m.squaredNorm(), options.silhouette_robust_m);
    Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
    root.row(0) = std::sqrt(weight) * at.way_m.normalized().transpose();
    const SurfacePoint& point = Surface().points[i];
    places.push_back({point.segment, point.place, posed.at_m()[i] + at.way_m, root});
  }
}

void DrawJoints(const PosedSurface& posed, const SurfaceFitInput& input,
                const SurfaceFitOptions& options, std::vector<DrawnPlace>& places) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!input.confidence[j]) continue;
    const Eigen::Vector3d& to_m = input.joints_m.position_m[j];
    const double weight =
        GemanMcClure((posed.LandmarkAt(j) - to_m).squaredNorm(), options.joint_robust_m) /
        ComputeJointVariance_m2(input, options, j);
    places.push_back({Surface().landmark_segment[j], Surface().landmark[j], to_m,
                      std::sqrt(weight) * Eigen::Matrix3d::Identity()});
  }
}

}  // namespace

ExactProblem ExactProblem::About(const PosedSurface& posed, const SeenPerson& seen,
                                 const SurfaceFitInput& input, const SurfaceFitOptions& options) {
  ExactProblem problem;
  problem.pose = posed.pose();
  problem.known_shape = input.shape;
  DrawJoints(posed, input, options, problem.places);
  DrawPixels(posed, seen, options, problem.places);
  DrawIntoSilhouette(posed, seen, options, problem.places);
  return problem;
}

ExactEquations Differentiate(const ExactProblem& problem) {
  Unknowns x{};
  ceres::Problem ceres_problem;
  AddTo(ceres_problem, problem, x);
  ExactEquations equations;
  std::vector<double> gradient;
  ceres::CRSMatrix rows;
  ceres_problem.Evaluate({}, &equations.cost, nullptr, &gradient, &rows);
  equations.gradient = Eigen::Map<const FitStep>(gradient.data());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, kFitUnknowns, Eigen::RowMajor>>
      jacobian(rows.values.data(), rows.num_rows, kFitUnknowns);
  equations.matrix = jacobian.transpose() * jacobian;
  return equations;
}

SurfacePose Minimise(const ExactProblem& problem) {
  Unknowns x{};
  ceres::Problem ceres_problem;
  AddTo(ceres_problem, problem, x);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 100;
  options.function_tolerance = options.parameter_tolerance = options.gradient_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  EXPECT_TRUE(summary.IsSolutionUsable()) << summary.message;
  const MovedBody<double> moved(problem.pose, x.data());
  SurfacePose pose;
  pose.parent_from_segment = moved.parent_from;
  pose.pelvis_m = moved.joint_m[0];
  pose.shape = moved.shape;
  return pose;
}

}  // namespace ossa::recon
