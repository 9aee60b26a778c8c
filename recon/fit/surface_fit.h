#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "depth/image/depth_frame.h"
#include "recon/fit/body_surface.h"
#include "recon/fit/posed_surface.h"
#include "recon/posture.h"

namespace ossa::recon {

// Constants: chosen on rendered people in motion of another corpus (bandai_validation) and on the
// dev stills of `ossa experiment real`, unless stated otherwise; `ossa experiment fit` prints the
// contribution of each term.

/// Terms and weights of the surface fit. A weight is one over a variance.
struct SurfaceFitOptions {
  int start_iterations = 3;  // with the joints only
  int iterations = 5;        // with joints and image
  size_t most_pixels = 400;
  size_t fewest_pixels = 30;  // with fewer there is no fit

  // Image to model: each pixel is explained by the nearest point of the surface that faces the
  // camera.
  bool pixels = true;
  double pixel_m = 0.02;     // standard deviation along the normal, > 0 ...
  double footprint = 2.0;    // ... and, squares added, this multiple of the pixel's size
  double along_share = 0.5;  // weight of the distance along the surface, relative to the normal's
  double robust_m = 0.08;    // scale of Geman and McClure's weights, > 0
  double adjacent_part_m = 0.08;  // penalty added to the distance of a point of an adjacent part
  double other_part_m = 0.3;      // ... and of any other part

  // Model to image: points must lie within the silhouette, unless something hides them, and not in
  // front of the measured surface.
  bool silhouette = true;
  double silhouette_m = 0.06;         // standard deviation, > 0
  double silhouette_robust_m = 0.12;  // > 0
  double no_reading_share = 0.3;      // weight where the sensor has no reading
  // Off: it adds nothing to the other terms, and pulls limbs that the image blurs.
  bool free_space = false;
  double free_space_share = 0.3;  // weight relative to the silhouette's
  double free_space_m = 0.04;     // a surface this far behind a point contradicts it

  // Joints as proposed and refined. They are no more accurate than the image: see `footprint`.
  double joint_m = 0.02;         // standard deviation at confidence 1, > 0: the error of refined
                                 // joints on rendered people (docs/benchmarks)
  double doubt = 1.0;            // at confidence 0 it is 1 + doubt times that
  double joint_robust_m = 0.15;  // > 0
  double fitted_m = 0.02;        // of the fitted body's joints, for SurfaceFit::blended_m, >= 0

  /// Distance of the pixels from a joint's segment at which the joint's reliability is halved
  /// (after Shum et al. 2013, whose depth term asks whether a surface lies at a joint), >= 0. 0:
  /// off, because it gains nothing on real depth (docs/benchmarks/fit.md).
  double doubt_residual_m = 0.0;

  double turn_weight = 1.0;    // factor of the prior of joint rotations
  double shape_weight = 1.0;   // factor of the prior of shape (mean or earlier frames)
  double damping = 1e-3;       // Levenberg-Marquardt, share of the diagonal
  double most_turn_rad = 0.6;  // largest rotation of a joint in one iteration

  // A poor fit is repeated from its end with low weights of joints and a wide basin of the pixels,
  // in as many iterations as the first fit, start included.
  bool retry = true;
  double poor_score = 0.7;      // score below which a fit is poor, see SurfaceFit::score
  double least_gain = 0.06;     // gain of score for which the second fit is taken
  int retry_near = 3;           // number of its last iterations with the first fit's robust scale
  double retry_joint_m = 0.15;  // > 0
  double retry_robust_m = 0.3;  // > 0

  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// A person, and the image that shows them.
struct SurfaceFitInput {
  Posture joints_m;                              // as refined, camera space
  JointArray<std::optional<double>> confidence;  // [0, 1]; none: the joint is unknown
  const depth::DepthFrame* depth = nullptr;      // the whole image; borrowed
  std::span<const int32_t> pixels;               // the person's, v * width + u, ascending
  /// Those of `pixels` in rows and columns that are multiples of `sample_step`, and their parts:
  /// 1..31; 0: unknown; 32 or more: not the person, ignored. Empty: no part is
  /// known.
  std::span<const int32_t> samples;
  std::span<const uint8_t> parts;
  int sample_step = 1;
  /// The person's shape from earlier frames (PersonShape), and the number of these frames.
  ShapeVector shape = ShapeVector::Zero();
  int shape_frames = 0;
};

/// The body whose surface explains the depth.
struct SurfaceFit {
  SurfacePose pose;
  Posture joints_m;  // camera space
  /// Mean of those and the input joints, weighted by inverse variances: the fit contributes bone
  /// lengths and surface, the input what no surface shows. For unknown joints the
  /// fitted ones.
  Posture blended_m;
  std::array<Eigen::Quaterniond, kSegmentCount> camera_from_segment;  // from the rest pose's axes
  double stature_m = 0.0;
  /// Covariance of each of `joints_m`, camera axes, from the final Gauss-Newton Hessian scaled by
  /// the pixels' residuals. Its accuracy is in docs/benchmarks/fit.md.
  JointArray<Eigen::Matrix3d> covariance_m2;
  /// Information on shape from this image alone, without the prior: inverse covariance, and that
  /// times the most likely shape.
  ShapeMatrix shape_information = ShapeMatrix::Zero();
  ShapeVector shape_vote = ShapeVector::Zero();
  /// Share of the person's pixels within 3 cm of the surface, along its normal.
  double explained = 0.0;
  /// `explained` minus the share of surface points that the camera sees through: 1 is
  /// perfect.
  double score = 0.0;
  double median_residual_m = 0.0;
  /// Root mean square distance of each segment's pixels from it, metres; none without pixels.
  std::array<std::optional<double>, kSegmentCount> residual_m{};
  bool retried = false;  // the second of two fits was taken
  int iterations = 0;    // total number, start and second fit included
};

/// Fits the body's surface to a depth image: articulated iterative closest points by damped
/// Gauss-Newton, as Ganapathi et al. 2012, Ye and Yang 2014 and Taylor et al. 2016 do, started from
/// the refined joints. The same result every time; no allocation after the first frames. One object
/// fits one person at a time.
class SurfaceFitter {
 public:
  /// The surface must outlive this object. Throws std::invalid_argument for options out of range.
  explicit SurfaceFitter(const BodySurface& surface, const SurfaceFitOptions& options = {});
  ~SurfaceFitter();
  SurfaceFitter(SurfaceFitter&&) noexcept;
  SurfaceFitter& operator=(SurfaceFitter&&) noexcept;

  /// None if a joint or the camera is not finite or too few pixels have a reading. Throws
  /// std::invalid_argument if `parts` and `samples` differ in size or a pixel is outside the
  /// image.
  std::optional<SurfaceFit> Fit(const SurfaceFitInput& input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A person's shape from all frames, each weighted by how well it explained the image.
struct PersonShape {
  ShapeVector shape = ShapeVector::Zero();  // mean of the fits, with which the next fit begins
  /// Sums of SurfaceFit::shape_information and shape_vote: frames with hidden legs contribute
  /// nothing to their length.
  ShapeMatrix information = ShapeMatrix::Zero();
  ShapeVector vote = ShapeVector::Zero();
  double weight = 0.0;  // sum of the votes
  int frames = 0;
  void Add(const SurfaceFit& fit);
  /// The most likely shape given all frames, and its covariance. Errors of frames of one person are
  /// correlated, so that many frames are hardly more certain than one.
  ShapeVector Likeliest() const;
  ShapeMatrix Covariance() const;

  /// A person file, .ossaperson. It belongs to the body surface with which it was measured; reading
  /// throws InputError with the file's name for damaged files and for those of another
  /// surface.
  static PersonShape Load(const std::filesystem::path& path, const BodySurface& surface);
  static PersonShape FromBytes(std::span<const std::byte> bytes, const std::string& name,
                               const BodySurface& surface);
  void Save(const std::filesystem::path& path, const BodySurface& surface) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// Body height, metres, and its standard deviation: barefoot, without hair.
struct Stature {
  double stature_m = 0.0;
  double sigma_m = 0.0;
};
Stature MeasureStature(const PersonShape& person, const BodySurface& surface);

}  // namespace ossa::recon
