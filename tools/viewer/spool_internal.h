#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::viewer {

/// Compressed records of bytes on disk, read in any order. The file has no name and is deleted with
/// the object; memory takes 16 bytes per record. One thread at a time.
class Spool {
 public:
  /// In the folder for temporary files (TMPDIR). Throws InputError where none can be made there.
  Spool();
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// Throws InputError when the disk is full.
  void Append(std::string_view record);
  /// The i-th record appended.
  std::string Read(size_t i) const;
  size_t size() const { return places_.size(); }
  void Clear();

 private:
  struct Place {
    int64_t begin = 0;
    size_t size = 0;  // bytes in the file
  };
  int file_ = -1;
  int64_t end_ = 0;
  std::vector<Place> places_;
};

}  // namespace ossa::viewer
