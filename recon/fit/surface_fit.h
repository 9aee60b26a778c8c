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
// dev stills of `ossa experiment real`, where nothing else is said; `ossa experiment fit` prints
// what each term brings.

/// How the surface fit weighs its inputs. A weight is one over a variance.
struct SurfaceFitOptions {
  int start_iterations = 3;  // on joints alone
  int iterations = 5;        // on joints and image
  size_t most_pixels = 400;
  size_t fewest_pixels = 30;  // fewer say nothing: there is no fit

  // Image to model: each pixel is explained by the nearest point of the surface that faces the
  // camera.
  bool pixels = true;
  double pixel_m = 0.02;          // standard deviation along the normal, > 0 ...
  double footprint = 2.0;         // ... and so many times the pixel's own size at its distance
  double along_share = 0.5;       // weight of the distance along the surface, against the normal's
  double robust_m = 0.08;         // scale of Geman and McClure's weights, > 0
  double adjacent_part_m = 0.08;  // how much farther a point of an adjacent part counts to be
  double other_part_m = 0.3;      // and one of any other part

  // Model to image: no point lies beside the silhouette, unless something hides it, and none before
  // what is seen.
  bool silhouette = true;
  double silhouette_m = 0.06;         // standard deviation, > 0
  double silhouette_robust_m = 0.12;  // > 0
  double no_reading_share = 0.3;      // weight where the sensor has no reading
  // Off: alone it says what other terms say already, and pulls limbs that the image blurs.
  bool free_space = false;
  double free_space_share = 0.3;  // weight against the silhouette's
  double free_space_m = 0.04;     // a surface farther behind a point than this is seen through it

  // Joints as proposed and refined. They are no surer than the image: `footprint` counts, too.
  double joint_m = 0.02;         // standard deviation of one of confidence 1, > 0: what refined
                                 // joints are off by on rendered people (docs/benchmarks)
  double doubt = 1.0;            // of one of confidence 0: 1 + doubt times that
  double joint_robust_m = 0.15;  // > 0
  double fitted_m = 0.02;        // of a joint of the fitted body, for SurfaceFit::blended_m, >= 0

  /// How far the pixels of a joint's segment may be from it until the reconstruction believes the
  /// joint half as much (Shum et al. 2013 ask whether a surface lies where a joint is said to be),
  /// >= 0. 0, off: it gains nothing on real depth (docs/benchmarks/fit.md).
  double doubt_residual_m = 0.0;

  double turn_weight = 1.0;    // a factor, of how people hold themselves
  double shape_weight = 1.0;   // a factor, of the mean shape or what is known of the person's
  double damping = 1e-3;       // of Levenberg and Marquardt, share of the diagonal
  double most_turn_rad = 0.6;  // of a joint in one iteration

  // Where the fit is poor it is tried again from where it ended, with joints that say little and
  // pixels that pull from far off. That takes as many iterations as the first fit, start included.
  bool retry = true;
  double poor_score = 0.7;      // score below which it is poor, see SurfaceFit::score
  double least_gain = 0.06;     // of score, for the second fit to be taken
  int retry_near = 3;           // count, its last iterations, in which pixels pull as at first
  double retry_joint_m = 0.15;  // > 0
  double retry_robust_m = 0.3;  // > 0

  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// A person and the image they are seen in.
struct SurfaceFitInput {
  Posture joints_m;                              // as refined, camera space
  JointArray<std::optional<double>> confidence;  // [0, 1]; none: nothing is known of the joint
  const depth::DepthFrame* depth = nullptr;      // the whole image; borrowed
  std::span<const int32_t> pixels;               // the person's, v * width + u, ascending
  /// Of `pixels` those in rows and columns that are multiples of `sample_step` whose part is known,
  /// and their parts: 1..31, 0: not known, 32 or more: something else, which is left out. Empty: no
  /// part is known.
  std::span<const int32_t> samples;
  std::span<const uint8_t> parts;
  int sample_step = 1;
  /// What earlier frames say of the person's shape (PersonShape), and how many they were.
  ShapeVector shape = ShapeVector::Zero();
  int shape_frames = 0;
};

/// The body whose surface explains the depth.
struct SurfaceFit {
  SurfacePose pose;
  Posture joints_m;  // camera space
  /// Mean of those and the joints that the fit started from, each by its variance: a fit knows
  /// bones and surface, a detector of joints what no surface tells. Of joints of unknown confidence
  /// the fit's.
  Posture blended_m;
  std::array<Eigen::Quaterniond, kSegmentCount> camera_from_segment;  // from the rest pose's axes
  double stature_m = 0.0;
  /// How far `joints_m` may be off: covariance of each, camera axes, by the Gauss-Newton Hessian at
  /// the end, scaled by how far off the pixels are. What it is worth: docs/benchmarks/fit.md.
  JointArray<Eigen::Matrix3d> covariance_m2;
  /// What this image alone tells of shape, without what was known of it before: the inverse of the
  /// covariance, and that times the likeliest shape.
  ShapeMatrix shape_information = ShapeMatrix::Zero();
  ShapeVector shape_vote = ShapeVector::Zero();
  /// Share of the person's pixels within 3 cm of the surface, along its normal.
  double explained = 0.0;
  /// `explained` less the share of the surface's points through which the camera sees: 1 is
  /// perfect.
  double score = 0.0;
  double median_residual_m = 0.0;
  /// Root mean square distance of each segment's pixels from it, metres; none without pixels.
  std::array<std::optional<double>, kSegmentCount> residual_m{};
  bool retried = false;  // the second of two fits was the better one
  int iterations = 0;    // count, of all that was tried, start included: what the fit cost
};

/// Fits the body's surface to a depth image: articulated iterative closest points by damped
/// Gauss-Newton, as Ganapathi et al. 2012, Ye and Yang 2014 and Taylor et al. 2016 do, started from
/// the refined joints. The same result every time; no allocation after the first frames. One object
/// fits one person at a time.
class SurfaceFitter {
 public:
  /// Borrows the surface. Throws std::invalid_argument for options out of range.
  explicit SurfaceFitter(const BodySurface& surface, const SurfaceFitOptions& options = {});
  ~SurfaceFitter();
  SurfaceFitter(SurfaceFitter&&) noexcept;
  SurfaceFitter& operator=(SurfaceFitter&&) noexcept;

  /// None where a joint or the camera is not finite or too few of the pixels have a reading. Throws
  /// std::invalid_argument where `parts` and `samples` differ in number or a pixel is not in the
  /// image.
  std::optional<SurfaceFit> Fit(const SurfaceFitInput& input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A person's shape as frames vote on it, each by how well it explained the image.
struct PersonShape {
  ShapeVector shape = ShapeVector::Zero();  // mean of the fits', what the next fit begins with
  /// What they say by themselves, summed up, see SurfaceFit: a frame in which legs are hidden
  /// tells nothing of their length.
  ShapeMatrix information = ShapeMatrix::Zero();
  ShapeVector vote = ShapeVector::Zero();
  double weight = 0.0;  // sum of the votes
  int frames = 0;
  void Add(const SurfaceFit& fit);
  /// The likeliest shape by all of them, and its covariance. Frames of one person are wrong
  /// alike, so that many say hardly more than one.
  ShapeVector Likeliest() const;
  ShapeMatrix Covariance() const;

  /// A person file, .ossaperson: what is kept of somebody for the next time. It is of the body that
  /// it was measured with; reading throws InputError by name for damaged files and those of another
  /// body.
  static PersonShape Load(const std::filesystem::path& path, const BodySurface& surface);
  static PersonShape FromBytes(std::span<const std::byte> bytes, const std::string& name,
                               const BodySurface& surface);
  void Save(const std::filesystem::path& path, const BodySurface& surface) const;
  /// True when the file says that it is one; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// Body height, metres, and its standard deviation: barefoot, without hair.
struct Stature {
  double stature_m = 0.0;
  double sigma_m = 0.0;
};
Stature MeasureStature(const PersonShape& person, const BodySurface& surface);

}  // namespace ossa::recon
