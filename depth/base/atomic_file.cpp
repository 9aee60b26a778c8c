#include "depth/base/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <vector>

#include "depth/base/error.h"

namespace ossa {
namespace {

constexpr const char* kPartial = ".partial-";

// Two processes (MPI ranks, a second ossa) may write the same file: the name carries the process.
std::filesystem::path TemporaryPathFor(const std::filesystem::path& final_path) {
  std::filesystem::path path = final_path;
  path += kPartial + std::to_string(getpid());
  return path;
}

// Whether a name ends in the number of a process that lives no more.
bool IsOfTheDead(const std::string& name, size_t number_at) {
  pid_t process = 0;
  const auto [end, error] =
      std::from_chars(name.data() + number_at, name.data() + name.size(), process);
  const bool number = error == std::errc() && end == name.data() + name.size() && process > 0;
  return number && kill(process, 0) != 0 && errno == ESRCH;
}

// Processes of another machine or container that share the folder have numbers that say nothing
// here: what one of them writes is locked.
void RemoveUnlessLocked(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  if (flock(file, LOCK_EX | LOCK_NB) == 0) unlink(path.c_str());
  close(file);
}

void RemoveLeftovers(const std::filesystem::path& final_path) {
  const std::string begin = final_path.filename().string() + kPartial;
  const auto folder = final_path.has_parent_path() ? final_path.parent_path() : ".";
  std::vector<std::filesystem::path> leftovers;
  std::error_code error;
  for (auto it = std::filesystem::directory_iterator(folder, error);
       !error && it != std::filesystem::directory_iterator(); it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(begin) && IsOfTheDead(name, begin.size())) leftovers.push_back(it->path());
  }
  for (const auto& path : leftovers) RemoveUnlessLocked(path);
}

// Where a chain of symbolic links leads, also to where nothing is yet.
std::filesystem::path EndOfLinks(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // the kernel's own limit; by definition of MAXSYMLINKS
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
  lock_ = open(temporary_path_.c_str(), O_WRONLY | O_CLOEXEC);
  if (lock_ >= 0) flock(lock_, LOCK_EX | LOCK_NB);  // not every file system knows locks
}

AtomicFile::~AtomicFile() {
  if (!committed_) {
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(temporary_path_, ignored);
  }
  if (lock_ >= 0) close(lock_);
}

void AtomicFile::CheckWritable(const std::filesystem::path& final_path) {
  const AtomicFile probe(final_path);
  RemoveLeftovers(probe.final_path_);
}

void AtomicFile::Check() {
  if (!stream_) throw DiskFull(name_ + ": writing failed: is the disk full?");
}

void AtomicFile::CutTo(uint64_t size) {
  stream_.close();  // may still write something, which the cut takes away
  stream_.clear();
  std::error_code error;
  if (std::filesystem::file_size(temporary_path_, error) < size || error) {
    throw InputError(name_ + ": less was written than was thought: is the disk full?");
  }
  std::filesystem::resize_file(temporary_path_, size, error);
  if (error) throw InputError(name_ + ": cannot be cut shorter: " + error.message());
  errno = 0;
  stream_.open(temporary_path_, std::ios::binary | std::ios::in | std::ios::out | std::ios::ate);
  if (!stream_) throw InputError(name_ + ": cannot be written: " + std::strerror(errno));
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
