#include <archive.h>
#include <archive_entry.h>

#include <fstream>

#include "depth/base/error.h"
#include "depth/image/number_image_internal.h"
#include "depth/sensor/readers/arrays/array_file.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

// An array of a stream of .npy, and where its numbers begin.
struct NpyArray {
  ArrayInfo info;
  size_t data_offset = 0;
};

NpyArray DescribeNpy(std::span<const uint8_t> head, const std::string& name) {
  const NpyHeader header = ParseNpyHeader(head, name.empty() ? "" : name + ": ");
  ArrayInfo info{name, header.format, header.shape, header.is_fortran};
  if (header.is_fortran) std::reverse(info.shape.begin(), info.shape.end());
  std::erase(info.shape, 1);
  return {std::move(info), header.data_offset};
}

bool IsEmpty(const ArrayInfo& array) {
  return std::find(array.shape.begin(), array.shape.end(), 0) != array.shape.end();
}

class NpyFile final : public ArrayFile {
 public:
  explicit NpyFile(const fs::path& path) : file_(path, std::ios::binary) {
    std::vector<uint8_t> head(kLongestNpyHeader);
    file_.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<size_t>(file_.gcount()));
    file_.clear();
    array_ = DescribeNpy(head, "");
  }

  std::vector<ArrayInfo> List() override {
    return IsEmpty(array_.info) ? std::vector<ArrayInfo>{} : std::vector{array_.info};
  }

  std::vector<uint8_t> Read(const ArrayInfo& array, size_t first, size_t count) override {
    std::vector<uint8_t> numbers(count * array.SliceBytes());
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(array_.data_offset + first * array.SliceBytes()));
    file_.read(reinterpret_cast<char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size()));
    if (!file_) throw InputError("cut short in image " + std::to_string(first));
    return numbers;
  }

 private:
  std::ifstream file_;
  NpyArray array_;
};

// The entries of a zip file, read from their beginnings to their ends.
class ZipStream {
 public:
  explicit ZipStream(fs::path path) : path_(std::move(path)) { Restart(); }

  // Opens the next entry; false at the end.
  bool Next() {
    archive_entry* entry = nullptr;
    const int status = archive_read_next_header(archive_.get(), &entry);
    if (status == ARCHIVE_EOF) return false;
    if (status != ARCHIVE_OK && status != ARCHIVE_WARN) Fail();
    const char* name = archive_entry_pathname(entry);
    name_ = name == nullptr ? "" : name;
    position_ = 0;
    return true;
  }

  void Restart() {
    archive_.reset(archive_read_new());
    archive_read_support_format_zip(archive_.get());
    constexpr size_t kBlock = size_t{1} << 16;  // bytes, by hand
    if (archive_read_open_filename(archive_.get(), path_.c_str(), kBlock) != ARCHIVE_OK) Fail();
    name_.clear();
  }

  // As many of the next bytes of the entry as there are.
  std::vector<uint8_t> Take(size_t count) {
    std::vector<uint8_t> bytes(count);
    size_t taken = 0;
    while (taken < count) {
      const la_ssize_t some = archive_read_data(archive_.get(), &bytes[taken], count - taken);
      if (some < 0) Fail();
      if (some == 0) break;
      taken += static_cast<size_t>(some);
    }
    position_ += taken;
    bytes.resize(taken);
    return bytes;
  }

  // Goes to a byte of an entry: forward, or from its beginning.
  void Seek(const std::string& name, size_t position) {
    if (name_ != name || position_ > position) {
      Restart();
      while (name_ != name) {
        if (!Next()) throw InputError("its array " + name + " is gone");
      }
    }
    constexpr size_t kStep = size_t{1} << 20;  // bytes, by hand
    while (position_ < position) {
      if (Take(std::min(kStep, position - position_)).empty()) return;
    }
  }

  const std::string& name() const { return name_; }

 private:
  [[noreturn]] void Fail() {
    const char* error = archive_error_string(archive_.get());
    throw InputError(std::string("expected an archive of NumPy arrays (.npz)") +
                     (error == nullptr ? "" : std::string(": ") + error));
  }

  struct Free {
    void operator()(archive* opened) const { archive_read_free(opened); }
  };
  fs::path path_;
  std::unique_ptr<archive, Free> archive_;
  std::string name_;
  size_t position_ = 0;  // in the entry
};

class NpzFile final : public ArrayFile {
 public:
  explicit NpzFile(const fs::path& path) : zip_(path) {
    while (Next()) {
      const fs::path entry = zip_.name();
      if (entry.extension() != ".npy") continue;
      try {
        arrays_.push_back(DescribeNpy(zip_.Take(kLongestNpyHeader), entry.stem().string()));
      } catch (const InputError&) {  // texts and objects are no depths
      }
    }
  }

  std::vector<ArrayInfo> List() override {
    std::vector<ArrayInfo> listed;
    for (const NpyArray& array : arrays_) {
      if (!IsEmpty(array.info)) listed.push_back(array.info);
    }
    return listed;
  }

  std::vector<uint8_t> Read(const ArrayInfo& array, size_t first, size_t count) override {
    const auto found = std::find_if(arrays_.begin(), arrays_.end(), [&](const NpyArray& each) {
      return each.info.name == array.name;
    });
    zip_.Seek(array.name + ".npy", found->data_offset + first * array.SliceBytes());
    std::vector<uint8_t> numbers = zip_.Take(count * array.SliceBytes());
    if (numbers.size() < count * array.SliceBytes()) {
      throw InputError(array.name + ": cut short in image " + std::to_string(first));
    }
    return numbers;
  }

 private:
  // What lies before the damage of an archive is read.
  bool Next() {
    try {
      return zip_.Next();
    } catch (const InputError&) {
      if (arrays_.empty()) throw;
      return false;
    }
  }

  ZipStream zip_;
  std::vector<NpyArray> arrays_;
};

}  // namespace

std::unique_ptr<ArrayFile> OpenNpy(const fs::path& path) { return std::make_unique<NpyFile>(path); }
std::unique_ptr<ArrayFile> OpenNpz(const fs::path& path) { return std::make_unique<NpzFile>(path); }

}  // namespace ossa::depth
