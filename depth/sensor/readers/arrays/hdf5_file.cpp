#include <hdf5.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "depth/base/error.h"
#include "depth/sensor/readers/arrays/array_file.h"

namespace ossa::depth {
namespace {

// An identifier of the library, closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// The type in memory, which the library converts to.
hid_t TypeOf(const NumberFormat& format) {
  if (format.kind == NumberKind::kFloat) {
    return format.size == 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  }
  const bool has_sign = format.kind == NumberKind::kSigned;
  switch (format.size) {
    case 1:
      return has_sign ? H5T_NATIVE_INT8 : H5T_NATIVE_UINT8;
    case 2:
      return has_sign ? H5T_NATIVE_INT16 : H5T_NATIVE_UINT16;
    case 4:
      return has_sign ? H5T_NATIVE_INT32 : H5T_NATIVE_UINT32;
    default:
      return has_sign ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64;
  }
}

std::optional<NumberFormat> FormatOf(hid_t type) {
  const size_t size = H5Tget_size(type);
  const H5T_class_t kind = H5Tget_class(type);
  // Half floats are read as float.
  if (kind == H5T_FLOAT) return NumberFormat{NumberKind::kFloat, size > 4 ? 8 : 4};
  if (kind != H5T_INTEGER || size > 8) return std::nullopt;
  const bool has_sign = H5Tget_sign(type) == H5T_SGN_2;
  const int bytes = size == 3 ? 4 : size > 4 ? 8 : static_cast<int>(size);
  return NumberFormat{has_sign ? NumberKind::kSigned : NumberKind::kUnsigned, bytes};
}

class Hdf5File final : public ArrayFile {
 public:
  explicit Hdf5File(const std::filesystem::path& path) : file_(Open(path)) {
    if (!file_) {
      throw InputError(IsHdf5(path)
                           ? "expected a whole HDF5 file, found one that is cut short or damaged"
                           : "expected an HDF5 file");
    }
    std::vector<std::string> names;
    const auto keep = [](hid_t, const char* name, const H5O_info_t* info, void* kept) -> herr_t {
      if (info->type == H5O_TYPE_DATASET)
        static_cast<std::vector<std::string>*>(kept)->push_back(name);
      return 0;
    };
    if (H5Ovisit(file_.id(), H5_INDEX_NAME, H5_ITER_NATIVE, keep, &names) < 0) {
      throw InputError("its groups are damaged");
    }
    for (const std::string& name : names) {
      if (!name.starts_with("#refs#/"))
        AddAll(name, name, 0);  // there MATLAB keeps what cells hold
    }
  }

  std::vector<ArrayInfo> List() override { return arrays_; }

  std::vector<uint8_t> Read(const ArrayInfo& array, size_t first, size_t count) override {
    const hid_t data = Keep(array.name);
    const Handle in_file(H5Dget_space(data), H5Sclose);
    std::vector<hsize_t> lengths = LengthsOf(in_file.id());
    std::vector<hsize_t> start(lengths.size(), 0);
    const auto slowest =
        std::find_if(lengths.begin(), lengths.end(), [](hsize_t length) { return length > 1; });
    if (slowest != lengths.end()) {
      start[static_cast<size_t>(slowest - lengths.begin())] = first;
      *slowest = count;
    }
    const Handle in_memory(
        H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr), H5Sclose);
    std::vector<uint8_t> numbers(count * array.SliceBytes());
    const bool is_chosen =
        lengths.empty() || H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, start.data(), nullptr,
                                               lengths.data(), nullptr) >= 0;
    if (!is_chosen || H5Dread(data, TypeOf(array.format), in_memory.id(), in_file.id(), H5P_DEFAULT,
                              numbers.data()) < 0) {
      throw InputError(array.name +
                       ": damaged, or compressed by a filter that the HDF5 library lacks here "
                       "('h5repack -f GZIP=1 FILE OUT' where it has it)");
    }
    return numbers;
  }

 private:
  // The data set, open until another is read: its chunks may hold many images, and stay unpacked.
  hid_t Keep(const std::string& name) {
    constexpr size_t kSlots = 10'007, kBytes = size_t{64} << 20;  // by hand; a prime number
    if (kept_ && kept_name_ == name) return kept_->id();
    const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    H5Pset_chunk_cache(access.id(), kSlots, kBytes, 1.0);
    kept_.emplace(H5Dopen2(file_.id(), paths_.at(name).c_str(), access.id()), H5Dclose);
    kept_name_ = name;
    return kept_->id();
  }

  static Handle Open(const std::filesystem::path& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are exceptions, not printed
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);  // read-only disks and networks have no locks
    return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  }

  static std::vector<hsize_t> LengthsOf(hid_t space) {
    const int rank = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> lengths(static_cast<size_t>(std::max(rank, 0)));
    H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
    return lengths;
  }

  // The data set at this path, or all to which it refers.
  void AddAll(const std::string& path, const std::string& name, int depth) {
    constexpr int kDeepest = 8;  // by hand: against circles
    const Handle data(H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!data) return;
    const Handle type(H5Dget_type(data.id()), H5Tclose);
    if (H5Tequal(type.id(), H5T_STD_REF_OBJ) <= 0) return Add(data.id(), type.id(), path, name);
    if (depth == kDeepest) return;
    const std::vector<std::string> paths = ReferencesOf(data.id());
    for (size_t i = 0; i < paths.size(); ++i) {
      if (!paths[i].empty()) AddAll(paths[i], name + "{" + std::to_string(i + 1) + "}", depth + 1);
    }
  }

  // The paths of what a data set of references refers to; "" for nothing.
  static std::vector<std::string> ReferencesOf(hid_t data) {
    constexpr hssize_t kMost = 100'000;  // by hand: against damage
    constexpr size_t kLongest = 1000;    // characters, by hand
    const Handle space(H5Dget_space(data), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if (count < 1 || count > kMost) return {};
    std::vector<hobj_ref_t> references(static_cast<size_t>(count));
    if (H5Dread(data, H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, references.data()) < 0) {
      return {};
    }
    std::vector<std::string> paths;
    for (const hobj_ref_t& reference : references) {
      std::string path(kLongest, '\0');
      const ssize_t length =
          H5Rget_name(data, H5R_OBJECT, &reference, path.data(), path.size() + 1);
      path.resize(std::min(path.size(), static_cast<size_t>(std::max<ssize_t>(length, 0))));
      paths.push_back(std::move(path));
    }
    return paths;
  }

  void Add(hid_t data, hid_t type, const std::string& path, const std::string& name) {
    const Handle space(H5Dget_space(data), H5Sclose);
    const auto format = FormatOf(type);
    if (!format || H5Sget_simple_extent_type(space.id()) == H5S_NULL) return;
    ArrayInfo info{name, *format, {}, H5Aexists(data, "MATLAB_class") > 0};
    for (const hsize_t length : LengthsOf(space.id())) info.shape.push_back(length);
    if (std::find(info.shape.begin(), info.shape.end(), 0) != info.shape.end()) return;
    std::erase(info.shape, 1);
    paths_[name] = path;
    arrays_.push_back(std::move(info));
  }

  Handle file_;
  std::optional<Handle> kept_;
  std::string kept_name_;
  std::vector<ArrayInfo> arrays_;
  std::map<std::string, std::string> paths_;  // of arrays by name
};

}  // namespace

bool IsHdf5(const std::filesystem::path& path) { return H5Fis_hdf5(path.c_str()) > 0; }

std::unique_ptr<ArrayFile> OpenHdf5(const std::filesystem::path& path) {
  return std::make_unique<Hdf5File>(path);
}

}  // namespace ossa::depth
