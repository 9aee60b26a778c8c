#pragma once
#include <cstdint>
#include <filesystem>

namespace ossa {

/// A file without a name, for what is too much to be held in memory until it is needed: it is gone
/// with the process, however that ends.
class UnnamedFile {
 public:
  UnnamedFile() = default;
  /// On the disk of the folder. Throws InputError when there can be none.
  explicit UnnamedFile(const std::filesystem::path& folder);
  ~UnnamedFile();
  UnnamedFile(UnnamedFile&& other) noexcept;
  UnnamedFile& operator=(UnnamedFile&& other) noexcept;

  bool is_open() const { return file_ >= 0; }
  /// Throws DiskFull.
  void WriteAt(uint64_t place, const void* bytes, size_t size);
  /// Throws InputError unless so many bytes are there.
  void ReadAt(uint64_t place, void* bytes, size_t size) const;

 private:
  int file_ = -1;
  std::filesystem::path folder_;  // for messages
};

}  // namespace ossa
