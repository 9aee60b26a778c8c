#include "depth/base/unnamed_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"

namespace ossa {
namespace {

// For file systems without support for unnamed files.
int OpenAndUnlink(const std::filesystem::path& folder) {
  std::string name = (folder / ".ossa-XXXXXX").string();  // mkostemp fills in the last six
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) unlink(name.c_str());
  return file;
}

}  // namespace

UnnamedFile::UnnamedFile(const std::filesystem::path& folder)
    : name_("a temporary file in " +
            std::filesystem::absolute(folder).lexically_normal().string()) {
  file_ = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file_ < 0) file_ = OpenAndUnlink(folder);
  if (file_ < 0) {
    throw InputError(name_ + ": cannot be made: " + std::strerror(errno));
  }
}

UnnamedFile::~UnnamedFile() {
  if (file_ >= 0) close(file_);
}

UnnamedFile::UnnamedFile(UnnamedFile&& other) noexcept
    : file_(std::exchange(other.file_, -1)), name_(std::move(other.name_)) {}

UnnamedFile& UnnamedFile::operator=(UnnamedFile&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(name_, other.name_);
  return *this;
}

void UnnamedFile::WriteAt(uint64_t place, const void* bytes, size_t size) {
  const auto* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = pwrite(file_, at, size, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw DiskFull(name_ + ": writing failed: is the disk full?");
    at += written;
    place += static_cast<uint64_t>(written);
    size -= static_cast<size_t>(written);
  }
}

void UnnamedFile::ReadAt(uint64_t place, void* bytes, size_t size) const {
  auto* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = pread(file_, at, size, static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw InputError(name_ + ": what was written cannot be read again");
    at += got;
    place += static_cast<uint64_t>(got);
    size -= static_cast<size_t>(got);
  }
}

}  // namespace ossa
