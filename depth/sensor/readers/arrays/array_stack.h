#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/camera.h"
#include "depth/sensor/readers/arrays/array_file.h"

namespace ossa::depth {

/// Images in arrays: one of two dimensions, many of those that are alike, or one of three.
struct ArrayStack {
  std::string name;               // of the array, or what the names have in common
  std::vector<ArrayInfo> arrays;  // in their order
  size_t count = 0;               // of images
  int width = 0, height = 0;
  size_t frame_axis = 0;            // of `shape`; of an array of two dimensions none: its length
  std::array<size_t, 3> step = {};  // numbers from one image, row, column to the next

  const NumberFormat& format() const { return arrays.front().format; }
  /// Whether an image is a slice of the file; else it is gathered from the whole array.
  bool IsSliced() const { return arrays.size() > 1 || frame_axis == 0; }
  std::string Describe() const;  // "depth, 300 images of 320x240, uint16"
};

/// The images that an array of two or three dimensions may be; none for other arrays. Of three
/// dimensions the first counts the images, or MATLAB's last; the other end if the images were
/// no images otherwise, or if only so they have the size of a known camera.
std::optional<ArrayStack> FindStack(const ArrayInfo& array);

/// The depth images of a file, those in `asked` or, if that is "", those named after depth, or the
/// only ones. Throws InputError if there is none, or several.
ArrayStack ChooseStack(const std::vector<ArrayInfo>& arrays, const std::string& asked);

/// An array of as many numbers as there are images, named after time or stamps, or as many single
/// numbers whose names differ in their counts, in their order; empty if there are none.
std::vector<ArrayInfo> FindTimes(const std::vector<ArrayInfo>& arrays, size_t images);

/// A matrix of 3 x 3 named as cameras' are: K, intrinsics, camera_matrix; none if there is none.
const ArrayInfo* FindCameraMatrix(const std::vector<ArrayInfo>& arrays);

/// The camera of a matrix, row by row or column by column; none if it is none of such images.
std::optional<Camera> CameraOfMatrix(const std::vector<double>& matrix, int width, int height);

}  // namespace ossa::depth
