#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "recon/fit/surface_fit.h"

namespace ossa::recon {

/// The person's pixels, subsampled for the fit, and the silhouette. Reuses its memory between
/// frames.
class SeenPerson {
 public:
  struct Pixel {
    Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  // camera space
    uint8_t part = 0;                                // 0: unknown
    double weight = 0.0;                             // 1 / m^2
  };

  void Look(const SurfaceFitInput& input, const SurfaceFitOptions& options);

  const std::vector<Pixel>& pixels() const { return pixels_; }
  /// Weight factor that normalises more than most_pixels pixels to the weight of most_pixels.
  double pixel_share() const { return pixel_share_; }

  /// Visibility of a point at its projection.
  enum class Sight {
    kNothing,    // outside the image or the grid, or behind the camera
    kPerson,     // this person's surface
    kBeside,     // background beside the person
    kNoReading,  // no reading beside the person
    kHidden,     // occluded
  };
  struct SightAt {
    Sight sight = Sight::kNothing;
    double behind_m = 0.0;  // of kPerson: depth of the surface minus that of the point
    /// Of kBeside and kNoReading: displacement to the silhouette, perpendicular to the line of
    /// sight.
    Eigen::Vector3d way_m = Eigen::Vector3d::Zero();
  };
  SightAt At(const Eigen::Vector3d& place_m) const;

 private:
  void TakePixels(const SurfaceFitInput& input, const SurfaceFitOptions& options);
  void MakeSilhouette(const SurfaceFitInput& input);
  void FindNearest();
  static constexpr int16_t kNowhere = -16384;  // derived: farther than any image is wide
  struct Cell {
    int16_t x = kNowhere, y = kNowhere;
  };
  template <bool kFromAnother>
  void SweepRow(int y, int from_y, bool rightwards);
  size_t stride() const { return static_cast<size_t>(width_) + 2; }
  size_t IndexOf(int x, int y) const {
    return static_cast<size_t>(y + 1) * stride() + static_cast<size_t>(x + 1);
  }
  Cell& CellAt(int x, int y) { return nearest_[IndexOf(x, y)]; }
  const Cell& CellAt(int x, int y) const { return nearest_[IndexOf(x, y)]; }

  const depth::DepthFrame* frame_ = nullptr;
  std::vector<Pixel> pixels_;
  double pixel_share_ = 1.0;
  // The silhouette as a grid of cells around the person.
  int left_ = 0, top_ = 0, cell_px_ = 1, width_ = 0, height_ = 0;
  // The nearest person cell of each cell, including a border around the grid.
  std::vector<Cell> nearest_;
  std::vector<int16_t> column_cell_;  // grid column of each image column
};

}  // namespace ossa::recon
