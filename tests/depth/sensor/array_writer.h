#pragma once
#include <archive.h>
#include <archive_entry.h>
#include <hdf5.h>
#include <matio.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ossa::test {

using Shape = std::vector<size_t>;

/// An .npy file of version 1: `type` as "<u2". The numbers are stored as they are.
template <typename T>
std::string NpyBytes(const std::string& type, const Shape& shape, const std::vector<T>& numbers,
                     bool is_fortran = false) {
  std::string header = "{'descr': '" + type +
                       "', 'fortran_order': " + (is_fortran ? "True" : "False") + ", 'shape': (";
  for (const size_t side : shape) header += std::to_string(side) + ", ";
  header += "), }";
  header.resize((header.size() + 10 + 64) / 64 * 64 - 10, ' ');  // NumPy aligns to 64 bytes
  header.back() = '\n';
  std::string bytes = "\x93NUMPY";
  bytes +=
      {'\1', '\0', static_cast<char>(header.size() & 255), static_cast<char>(header.size() >> 8)};
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
  return bytes;
}

/// An .npz file of arrays by name.
inline void WriteNpz(const std::filesystem::path& path,
                     const std::vector<std::pair<std::string, std::string>>& arrays,
                     bool is_compressed) {
  archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  archive_write_set_options(zip,
                            is_compressed ? "zip:compression=deflate" : "zip:compression=store");
  archive_write_open_filename(zip, path.c_str());
  for (const auto& [name, bytes] : arrays) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, (name + ".npy").c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_write_header(zip, entry);
    archive_write_data(zip, bytes.data(), bytes.size());
    archive_entry_free(entry);
  }
  archive_write_free(zip);
}

/// Variables of MATLAB: numbers in MATLAB's order, the first dimension changing fastest.
class MatWriter {
 public:
  explicit MatWriter(const std::filesystem::path& path)
      : file_(Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5)) {}
  MatWriter(const MatWriter&) = delete;
  MatWriter& operator=(const MatWriter&) = delete;
  ~MatWriter() { Mat_Close(file_); }

  template <typename T>
  MatWriter& Add(const std::string& name, matio_classes type, matio_types stored, Shape shape,
                 std::vector<T> numbers, matio_compression compression = MAT_COMPRESSION_ZLIB) {
    matvar_t* variable = Mat_VarCreate(name.c_str(), type, stored, static_cast<int>(shape.size()),
                                       shape.data(), numbers.data(), 0);
    return Write(variable, compression);
  }

  /// Arrays in the cells of one row.
  template <typename T>
  MatWriter& AddCells(const std::string& name, matio_classes type, matio_types stored, Shape shape,
                      std::vector<std::vector<T>> cells,
                      matio_compression compression = MAT_COMPRESSION_ZLIB) {
    std::vector<matvar_t*> inside;
    for (std::vector<T>& numbers : cells) {
      inside.push_back(Mat_VarCreate(nullptr, type, stored, static_cast<int>(shape.size()),
                                     shape.data(), numbers.data(), 0));
    }
    inside.push_back(nullptr);
    std::array<size_t, 2> row = {1, cells.size()};
    return Write(
        Mat_VarCreate(name.c_str(), MAT_C_CELL, MAT_T_CELL, 2, row.data(), inside.data(), 0),
        compression);
  }

  /// Arrays as the fields "depth" of a struct array of one row, each beside a number "t".
  template <typename T>
  MatWriter& AddStructs(const std::string& name, matio_classes type, matio_types stored,
                        Shape shape, std::vector<std::vector<T>> elements,
                        matio_compression compression = MAT_COMPRESSION_ZLIB) {
    std::array<const char*, 2> fields = {"t", "depth"};
    std::array<size_t, 2> row = {1, elements.size()}, one = {1, 1};
    matvar_t* variable = Mat_VarCreateStruct(name.c_str(), 2, row.data(), fields.data(), 2);
    for (size_t i = 0; i < elements.size(); ++i) {
      double time = 20.0 + 0.25 * static_cast<double>(i);
      Mat_VarSetStructFieldByName(
          variable, "t", i,
          Mat_VarCreate(nullptr, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one.data(), &time, 0));
      Mat_VarSetStructFieldByName(
          variable, "depth", i,
          Mat_VarCreate(nullptr, type, stored, static_cast<int>(shape.size()), shape.data(),
                        elements[i].data(), 0));
    }
    return Write(variable, compression);
  }

 private:
  MatWriter& Write(matvar_t* variable, matio_compression compression) {
    Mat_VarWrite(file_, variable, compression);
    Mat_VarFree(variable);
    return *this;
  }

  mat_t* file_;
};

/// Data sets of HDF5; groups in their names are made.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;
  ~Hdf5Writer() { H5Fclose(file_); }

  /// `matlab`: the class that MATLAB notes at its variables; "": none.
  template <typename T>
  Hdf5Writer& Add(const std::string& name, hid_t type, const Shape& shape,
                  const std::vector<T>& numbers, const std::string& matlab = "") {
    const std::vector<hsize_t> lengths(shape.begin(), shape.end());
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), lengths.data(), nullptr);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t data =
        H5Dcreate2(file_, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    if (!matlab.empty()) Note(data, matlab);
    H5Dclose(data);
    H5Pclose(links);
    H5Sclose(space);
    return *this;
  }

  /// References to data sets, as MATLAB's cells are stored.
  Hdf5Writer& Refer(const std::string& name, const std::vector<std::string>& to) {
    std::vector<hobj_ref_t> references(to.size());
    for (size_t i = 0; i < to.size(); ++i) {
      H5Rcreate(&references[i], file_, to[i].c_str(), H5R_OBJECT, -1);
    }
    return Add(name, H5T_STD_REF_OBJ, {to.size(), 1}, references, "cell");
  }

 private:
  static void Note(hid_t data, const std::string& matlab) {
    const hid_t text = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(text, matlab.size());
    const hid_t note = H5Acreate2(data, "MATLAB_class", text, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(note, text, matlab.data());
    H5Aclose(note);
    H5Sclose(space);
    H5Tclose(text);
  }

  hid_t file_;
};

}  // namespace ossa::test
