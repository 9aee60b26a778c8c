#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "recon/fit/surface_fit.h"

namespace ossa::recon {

/// What the image shows of the person, thinned out for the fit. Holds its memory from frame to
/// frame.
class SeenPerson {
 public:
  struct Pixel {
    Eigen::Vector3d at_m;  // camera space
    uint8_t part = 0;      // 0: not known
    double weight = 0.0;   // 1 / m^2
  };

  void Look(const SurfaceFitInput& input, const SurfaceFitOptions& options);

  const std::vector<Pixel>& pixels() const { return pixels_; }
  /// Pixels that stand for one of most_pixels: weights are made as if there were no more.
  double pixel_share() const { return pixel_share_; }

  /// What the camera sees at the pixel of a place.
  enum class Sight {
    kNothing,    // outside of the image or of what is near the person, or behind the camera
    kPerson,     // this person's surface
    kBeside,     // farther things beside the person
    kNoReading,  // beside the person, where the sensor says nothing
    kHidden,     // something before it
  };
  struct SightAt {
    Sight sight = Sight::kNothing;
    double behind_m = 0.0;  // of kPerson: how much farther than the place the surface is
    /// Of kBeside and kNoReading: from the place to the silhouette, across the line of sight.
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
  // The silhouette on a grid of cells around the person.
  int left_ = 0, top_ = 0, cell_px_ = 1, width_ = 0, height_ = 0;
  // Of each cell, and of a border around all, the nearest that is the person's.
  std::vector<Cell> nearest_;
  std::vector<int16_t> column_cell_;  // of each column of the image
};

}  // namespace ossa::recon
