#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "recon/files/skeleton_io.h"

namespace ossa::recon {

/// State of reading a file, folder or archive: options and progress.
struct Reading {
  const SkeletonReadOptions& options;
  std::string columns;        // result of Columns()
  uint64_t done = 0, of = 0;  // bytes on disk

  /// Reports progress: `more` bytes beyond `done` were read.
  void Tell(uint64_t more) const {
    if (options.progress) options.progress(std::min(done + more, of), of);
  }
};

/// A file buffer that reports progress as it is read.
class WatchedFile final : public std::filebuf {
 public:
  WatchedFile(const std::filesystem::path& path, const Reading& reading) : reading_(reading) {
    open(path, std::ios::in | std::ios::binary);
  }

 protected:
  int_type underflow() override {
    const int_type next = std::filebuf::underflow();
    taken_ += static_cast<uint64_t>(egptr() - gptr());
    reading_.Tell(taken_);
    return next;
  }

 private:
  const Reading& reading_;
  uint64_t taken_ = 0;  // includes the bytes read to detect the format
};

}  // namespace ossa::recon
