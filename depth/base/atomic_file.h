#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "depth/base/error.h"

namespace ossa {

/// The data did not fit: the disk is full, or the file reached its size limit.
struct DiskFull : InputError {
  using InputError::InputError;
};

/// A file that appears under its final name only when complete. It is written beside it under a
/// temporary name, NAME.partial- and random digits (a NAME that would become too long is shortened,
/// with a digest), renamed by Commit(), and removed by the destructor without it. The leftover of a
/// killed process stays under the temporary name. Throws InputError if the location is not writable
/// (no such folder, disk full), or a folder or device has that name: a rename would replace the
/// device by a file. A symbolic link is kept and its target is written. A write-protected file is
/// not replaced, although its folder would allow it. A replaced file passes on its permissions.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  /// Throws the constructor's InputError, without leaving a file. For output that is written after
  /// hours of work.
  static void CheckWritable(const std::filesystem::path& final_path);
  /// Leftovers of this file from killed processes: no process writes them any more. Sorted by name.
  /// Empty on file systems without locks, where leftovers cannot be recognised.
  static std::vector<std::filesystem::path> FindLeftovers(const std::filesystem::path& final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream();
  const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Throws DiskFull if a write has failed. For files written over hours, so that a full disk is
  /// noticed early.
  void Check();
  /// Flushes and checks: the data so far are in the file, and stay there if later writes fail or
  /// the process is killed. (A power loss may still lose them.)
  void Flush();
  /// Truncates the file to `size` bytes and clears write errors; writing continues there. Throws
  /// InputError if the file is shorter; only flushed bytes are certain to be in it.
  void CutTo(uint64_t size);
  /// Removes `count` bytes at `begin` and moves up the rest: for a header shorter than the space
  /// reserved for it. Flushes and checks; writing continues at the end.
  void RemoveBytes(uint64_t begin, uint64_t count);
  /// Flushes, checks, syncs to disk, and renames. The object must not be used afterwards.
  void Commit();
  /// As Commit without syncing: for one of thousands of files (images of a data set), whose folder
  /// is complete when another file, written after SyncFiles(), says so.
  void CommitOneOfMany();

 private:
  struct Stream;
  void Rename();

  std::string name_;  // as given, for messages
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  int file_ = -1;  // locked while it is being written
  std::unique_ptr<Stream> stream_;
  bool committed_ = false;
};

/// The folder that a file is in, "." where the path names none.
std::filesystem::path FolderOf(const std::filesystem::path& path);

/// Syncs all files of a folder and its sub-folders to disk. Throws DiskFull.
void SyncFiles(const std::filesystem::path& folder);

}  // namespace ossa
