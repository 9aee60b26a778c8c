#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "depth/image/number_format.h"

namespace ossa::depth {

/// An array of numbers in a file: NumPy's, a variable of MATLAB, a data set of HDF5.
struct ArrayInfo {
  std::string name;
  NumberFormat format;
  std::vector<size_t> shape;     // without lengths of 1; the last changes fastest in the file
  bool is_column_major = false;  // MATLAB's and Fortran's: users read `shape` backwards

  /// Numbers of one slice along the first dimension of `shape`.
  size_t SliceSize() const {
    return shape.empty()
               ? 1
               : std::accumulate(shape.begin() + 1, shape.end(), size_t{1}, std::multiplies<>());
  }
  size_t SliceBytes() const { return SliceSize() * static_cast<size_t>(format.size); }
  size_t SliceCount() const { return shape.empty() ? 1 : shape.front(); }
};

/// A file of arrays. All throw InputError for a damaged file.
class ArrayFile {
 public:
  virtual ~ArrayFile() = default;
  /// The arrays of integers and floats, without those that hold nothing.
  virtual std::vector<ArrayInfo> List() = 0;
  /// `count` slices of an array of this file along its first dimension, from `first` on.
  virtual std::vector<uint8_t> Read(const ArrayInfo& array, size_t first, size_t count) = 0;
};

std::unique_ptr<ArrayFile> OpenNpy(const std::filesystem::path& path);
/// An archive of .npy files, compressed or not.
std::unique_ptr<ArrayFile> OpenNpz(const std::filesystem::path& path);
/// A MAT file of version 5, 6 or 7: its variables, those inside of structs and cells by MATLAB's
/// names, s.depth, depth{7}. Version 7.3 is HDF5.
std::unique_ptr<ArrayFile> OpenMat(const std::filesystem::path& path);
bool IsHdf5(const std::filesystem::path& path);
/// The data sets of an HDF5 file, in any group, named by their path; those to which another one
/// refers, as MATLAB's cells do, by that one's and a number, depth{7}.
std::unique_ptr<ArrayFile> OpenHdf5(const std::filesystem::path& path);

}  // namespace ossa::depth
