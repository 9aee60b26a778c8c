#include "depth/base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <string_view>
#include <system_error>

#include "depth/base/descriptor_buffer_internal.h"
#include "depth/base/error.h"
#include "depth/base/leftovers.h"
#include "depth/base/long_name.h"

namespace ossa {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartial = ".partial-";
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr size_t kRandomBytes = 6;  // twelve digits: collisions are negligible; by hand

// Two hexadecimal digits per byte.
std::string HexOf(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kHexDigits[byte / 16];
    text += kHexDigits[byte % 16];
  }
  return text;
}

// The temporary name without its random suffix: the file name and `.partial-`, shortened to what
// the file system allows.
fs::path TemporaryNameBegin(const fs::path& final_path) {
  std::string name = final_path.filename().string();
  const size_t added = kPartial.size() + 2 * kRandomBytes;
  const size_t room = LongestNameIn(FolderOf(final_path));
  // A name that is too long itself is left as it is, and refused later.
  if (name.size() <= room && name.size() + added > room) name = ShortenName(name, room - added);
  return final_path.parent_path() / name.append(kPartial);
}

// An unpredictable name: in a folder that others may write to, nobody can have placed a file there.
fs::path RandomNameFor(const fs::path& final_path) {
  std::array<unsigned char, kRandomBytes> random{};
  if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    throw std::system_error(errno, std::generic_category(), "random numbers");
  }
  return TemporaryNameBegin(final_path) += HexOf(random);
}

// Whether the name looks like one of RandomNameFor.
bool IsRandomName(const std::string& name) {
  constexpr size_t kEnd = kPartial.size() + 2 * kRandomBytes;
  if (name.size() <= kEnd) return false;
  const std::string_view end = std::string_view(name).substr(name.size() - kEnd);
  return end.starts_with(kPartial) &&
         end.find_first_not_of(kHexDigits, kPartial.size()) == std::string_view::npos;
}

// Creates a new file exclusively and locks it; -1 with errno on failure.
int OpenNew(const fs::path& final_path, fs::path* path) {
  constexpr int kAttempts = 100;  // by hand: taken names are very unlikely
  for (int k = 0; k < kAttempts; ++k) {
    *path = RandomNameFor(final_path);
    const int file = open(path->c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0 && errno == EEXIST) continue;
    if (file >= 0) flock(file, LOCK_EX | LOCK_NB);  // not every file system supports locks
    return file;
  }
  return -1;
}

// Whether a temporary file is a leftover: no process holds its lock.
bool IsLeft(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return false;
  const bool free = flock(file, LOCK_SH | LOCK_NB) == 0;
  close(file);
  return free;
}

// The target of a chain of symbolic links, which need not exist.
fs::path FollowLinks(fs::path path) {
  constexpr int kMostLinks = 40;  // the kernel's own limit; by definition of MAXSYMLINKS
  std::error_code error;
  for (int k = 0; fs::is_symlink(path, error); ++k) {
    if (k == kMostLinks) {
      throw InputError(path.string() + ": cannot be written: " + std::strerror(ELOOP));
    }
    path = path.parent_path() / fs::read_symlink(path);  // an absolute link replaces the path
  }
  return path;
}

// fsync of a file or folder; false with errno on failure. Not every file system supports it.
bool Sync(int file) {
  int status = fsync(file);
  while (status != 0 && errno == EINTR) status = fsync(file);
  return status == 0 || errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP;
}

void SyncFolder(const fs::path& folder, const std::string& name) {
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;  // may be written to, but not read
  const bool synced = Sync(file);
  const int reason = errno;
  close(file);
  if (!synced) throw InputError(name + ": may not be on the disk: " + std::strerror(reason));
}

}  // namespace

struct AtomicFile::Stream {
  explicit Stream(int file) : buffer(file), stream(&buffer) {}
  DescriptorBuffer buffer;
  std::ostream stream;
};

AtomicFile::AtomicFile(fs::path final_path)
    : name_(final_path.string()), final_path_(FollowLinks(std::move(final_path))) {
  std::error_code unknown;
  const auto there = fs::status(final_path_, unknown);
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw InputError(name_ + ": cannot be written: expected a file or nothing, found " +
                     (fs::is_directory(there) ? "a folder" : "a device"));
  }
  errno = 0;
  if (fs::exists(there) && access(final_path_.c_str(), W_OK) != 0) {
    throw InputError(name_ + ": cannot be written: " + std::strerror(errno));
  }
  file_ = OpenNew(final_path_, &temporary_path_);
  if (file_ < 0) throw InputError(name_ + ": cannot be written: " + std::strerror(errno));
  // Not every file system supports permissions.
  if (fs::exists(there)) fchmod(file_, static_cast<mode_t>(there.permissions()) & 0777U);
  stream_ = std::make_unique<Stream>(file_);
}

AtomicFile::~AtomicFile() {
  if (!committed_) unlink(temporary_path_.c_str());
  close(file_);
}

std::ostream& AtomicFile::stream() { return stream_->stream; }

void AtomicFile::CheckWritable(const fs::path& final_path) { const AtomicFile probe(final_path); }

std::vector<fs::path> AtomicFile::FindLeftovers(const fs::path& final_path) {
  const fs::path end = FollowLinks(final_path);
  const std::string begin = TemporaryNameBegin(end).filename().string();
  std::vector<fs::path> left;
  std::error_code error;
  for (auto it = fs::directory_iterator(FolderOf(end), error);
       !error && it != fs::directory_iterator(); it.increment(error)) {
    const bool is_one = it->path().filename().string().starts_with(begin);
    if (is_one && it->is_regular_file(error) && IsLeft(it->path())) left.push_back(it->path());
  }
  std::sort(left.begin(), left.end());
  return left;
}

void RemoveLeftovers(const fs::path& folder) {
  std::vector<fs::path> left;
  std::error_code error;
  for (auto it = fs::recursive_directory_iterator(folder, error);
       !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
    const bool is_one = IsRandomName(it->path().filename().string());
    if (is_one && it->is_regular_file(error) && IsLeft(it->path())) left.push_back(it->path());
  }
  for (const fs::path& file : left) fs::remove(file, error);
}

void RemoveLeftoversOf(const fs::path& final_path) {
  std::error_code ignored;
  for (const fs::path& file : AtomicFile::FindLeftovers(final_path)) {
    if (IsRandomName(file.filename().string())) fs::remove(file, ignored);
  }
}

void AtomicFile::Check() {
  if (!stream()) throw DiskFull(name_ + ": writing failed: is the disk full?");
}

void AtomicFile::Flush() {
  stream().flush();
  Check();
}

void AtomicFile::CutTo(uint64_t size) {
  stream_->buffer.Discard();
  stream().clear();
  const off_t end = lseek(file_, 0, SEEK_END);
  if (end < 0 || static_cast<uint64_t>(end) < size) {
    throw InputError(name_ + ": less was written than was thought: is the disk full?");
  }
  if (ftruncate(file_, static_cast<off_t>(size)) != 0 || lseek(file_, 0, SEEK_END) < 0) {
    throw InputError(name_ + ": cannot be cut shorter: " + std::strerror(errno));
  }
}

void AtomicFile::RemoveBytes(uint64_t begin, uint64_t count) {
  Flush();
  std::vector<char> bytes(size_t{1} << 20);
  auto to = static_cast<off_t>(begin);
  for (;;) {
    const ssize_t got = pread(file_, bytes.data(), bytes.size(), to + static_cast<off_t>(count));
    if (got == 0) break;
    if (got < 0 || pwrite(file_, bytes.data(), static_cast<size_t>(got), to) != got) {
      throw InputError(name_ + ": cannot be moved together: " + std::strerror(errno));
    }
    to += got;
  }
  CutTo(static_cast<uint64_t>(to));
}

void AtomicFile::Rename() {
  std::error_code error;
  fs::rename(temporary_path_, final_path_, error);
  if (error) throw InputError(name_ + ": cannot be put in place: " + error.message());
  committed_ = true;
}

// Syncs file and folder: after a power loss the new name must not exist without its bytes, nor be
// lost.
void AtomicFile::Commit() {
  Flush();
  if (!Sync(file_)) throw DiskFull(name_ + ": writing failed: " + std::strerror(errno));
  Rename();
  SyncFolder(FolderOf(final_path_), name_);
}

void AtomicFile::CommitOneOfMany() {
  Flush();
  Rename();
}

fs::path FolderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void SyncFiles(const fs::path& folder) {
  std::error_code error;
  for (auto it = fs::recursive_directory_iterator(folder, error);
       !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
    if (!it->is_regular_file(error)) continue;
    const int file = open(it->path().c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) continue;  // not written by us
    const bool synced = Sync(file);
    const int reason = errno;
    close(file);
    if (!synced) throw DiskFull(it->path().string() + ": writing failed: " + std::strerror(reason));
  }
}

}  // namespace ossa
