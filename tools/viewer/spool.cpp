#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "depth/base/error.h"
#include "tools/viewer/spool_internal.h"

namespace ossa::viewer {
namespace {

std::string Folder() { return std::filesystem::temp_directory_path().string(); }

std::string Compress(std::string_view bytes) {
  constexpr int kFastest = 1;  // zstd's level, of its documentation: by hand, for speed
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kFastest);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

std::string Decompress(const std::string& packed) {
  std::string bytes(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
  const size_t size = ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (size != bytes.size()) throw std::runtime_error("spool: a record is damaged");
  return bytes;
}

}  // namespace

Spool::Spool() : file_(open(Folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)) {
  if (file_ >= 0) return;
  std::string name = Folder() + "/ossa-view-XXXXXX";  // where the file system has no unnamed files
  file_ = mkstemp(name.data());
  if (file_ < 0) throw InputError(Folder() + ": expected a folder for temporary files (TMPDIR)");
  unlink(name.c_str());
}

Spool::~Spool() { close(file_); }

void Spool::Append(std::string_view record) {
  const std::string packed = Compress(record);
  size_t written = 0;
  while (written < packed.size()) {
    const ssize_t now = pwrite(file_, packed.data() + written, packed.size() - written,
                               end_ + static_cast<int64_t>(written));
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) {
      throw InputError(Folder() + ": frames to look back at do not fit: " + strerror(errno) +
                       " (TMPDIR names another place)");
    }
    written += static_cast<size_t>(now);
  }
  places_.push_back({end_, packed.size()});
  end_ += static_cast<int64_t>(packed.size());
}

std::string Spool::Read(size_t i) const {
  const Place& place = places_.at(i);
  std::string packed(place.size, '\0');
  size_t read = 0;
  while (read < packed.size()) {
    const ssize_t now = pread(file_, packed.data() + read, packed.size() - read,
                              place.begin + static_cast<int64_t>(read));
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) throw std::runtime_error("spool: a record cannot be read");
    read += static_cast<size_t>(now);
  }
  return Decompress(packed);
}

void Spool::Clear() {
  places_.clear();
  end_ = 0;
  if (ftruncate(file_, 0) != 0) throw std::runtime_error("spool: cannot be emptied");
}

}  // namespace ossa::viewer
