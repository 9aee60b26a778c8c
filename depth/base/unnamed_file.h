#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace ossa {

/// An unnamed temporary file for data too large for memory: it disappears with the process, however
/// that ends.
class UnnamedFile {
 public:
  UnnamedFile() = default;
  /// Creates it on the disk of `folder`. Throws InputError on failure.
  explicit UnnamedFile(const std::filesystem::path& folder);
  ~UnnamedFile();
  UnnamedFile(UnnamedFile&& other) noexcept;
  UnnamedFile& operator=(UnnamedFile&& other) noexcept;

  bool is_open() const { return file_ >= 0; }
  /// Throws DiskFull.
  void WriteAt(uint64_t place, const void* bytes, size_t size);
  /// Throws InputError if the bytes are not there.
  void ReadAt(uint64_t place, void* bytes, size_t size) const;

 private:
  int file_ = -1;
  std::string name_;  // for messages
};

}  // namespace ossa
