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

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path final_path)
    : final_path_(std::move(final_path)), temporary_path_(TemporaryPathFor(final_path_)) {
  std::error_code unknown;
  const auto there = std::filesystem::status(final_path_, unknown);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
    throw InputError(final_path_.string() +
                     ": cannot be written: expected a file or nothing, found " +
                     (std::filesystem::is_directory(there) ? "a folder" : "a device"));
  }
  errno = 0;
  stream_.open(temporary_path_, std::ios::binary | std::ios::trunc);
  if (!stream_) {
    throw InputError(final_path_.string() + ": cannot be written: " + std::strerror(errno));
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

void AtomicFile::Commit() {
  stream_.close();
  if (!stream_) {
    throw InputError(final_path_.string() + ": writing failed: is the disk full?");
  }
  std::error_code error;
  std::filesystem::rename(temporary_path_, final_path_, error);
  if (error) {
    throw InputError(final_path_.string() + ": cannot be put in place: " + error.message());
  }
  committed_ = true;
}

}  // namespace ossa
