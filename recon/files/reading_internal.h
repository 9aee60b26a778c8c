#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "recon/files/skeleton_io.h"

namespace ossa::recon {

/// One reading of a file, a folder or an archive: how, and how far it is.
struct Reading {
  const SkeletonReadOptions& options;
  std::string columns;        // as Columns() says
  uint64_t done = 0, of = 0;  // bytes, as they lie on the disk

  /// Tells whoever waits that so many more than `done` are read.
  void Tell(uint64_t more) const {
    if (options.progress) options.progress(std::min(done + more, of), of);
  }
};

/// Tells how much of a file was read, whenever more of it is.
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
  uint64_t taken_ = 0;  // with what was looked at before, to tell the format
};

}  // namespace ossa::recon
