#include "depth/file/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "depth/error.h"

namespace ossa {
namespace {

// Two processes (MPI ranks, a second ossa) may write the same file: the name carries the process.
std::filesystem::path TemporaryPathFor(const std::filesystem::path& final_path) {
  std::filesystem::path path = final_path;
  path += ".partial-" + std::to_string(getpid());
  return path;
}

// Where a chain of symbolic links leads, also to where nothing is yet.
std::filesystem::path EndOfLinks(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // the kernel's own limit
  std::error_code error;
  for (int k = 0; std::filesystem::is_symlink(path, error); ++k) {
    if (k == kMostLinks) {
      throw InputError(path.string() + ": cannot be written: " + std::strerror(ELOOP));
    }
    path =
        path.parent_path() / std::filesystem::read_symlink(path);  // an absolute one stands alone
  }
  return path;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path final_path)
    : name_(final_path.string()),
      final_path_(EndOfLinks(std::move(final_path))),
      temporary_path_(TemporaryPathFor(final_path_)) {
  std::error_code unknown;
  const auto there = std::filesystem::status(final_path_, unknown);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
    throw InputError(name_ + ": cannot be written: expected a file or nothing, found " +
                     (std::filesystem::is_directory(there) ? "a folder" : "a device"));
  }
  errno = 0;
  if (std::filesystem::exists(there) && access(final_path_.c_str(), W_OK) != 0) {
    throw InputError(name_ + ": cannot be written: " + std::strerror(errno));
  }
  stream_.open(temporary_path_, std::ios::binary | std::ios::trunc);
  if (!stream_) {
    throw InputError(name_ + ": cannot be written: " + std::strerror(errno));
  }
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_path_, ignored);
}

void AtomicFile::CheckWritable(const std::filesystem::path& final_path) {
  const AtomicFile probe(final_path);
}

void AtomicFile::Check() {
  if (!stream_) throw InputError(name_ + ": writing failed: is the disk full?");
}

void AtomicFile::Commit() {
  stream_.close();
  Check();
  std::error_code error;
  std::filesystem::rename(temporary_path_, final_path_, error);
  if (error) {
    throw InputError(name_ + ": cannot be put in place: " + error.message());
  }
  committed_ = true;
}

}  // namespace ossa
