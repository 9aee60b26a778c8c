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
  struct Cell {
    int16_t x = -1, y = -1;  // -1: nowhere
  };
  void Consider(int x, int y, int dx, int dy);
  Cell& CellAt(int x, int y) {
    return nearest_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  }
  const Cell& CellAt(int x, int y) const {
    return nearest_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  }

  const depth::DepthFrame* frame_ = nullptr;
  std::vector<Pixel> pixels_;
  double pixel_share_ = 1.0;
  // The silhouette on a grid of cells around the person.
  int left_ = 0, top_ = 0, cell_px_ = 1, width_ = 0, height_ = 0;
  std::vector<Cell> nearest_;         // of each cell, the nearest that is the person's
  std::vector<int16_t> column_cell_;  // of each column of the image
};

}  // namespace ossa::recon
