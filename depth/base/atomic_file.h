#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "depth/base/error.h"

namespace ossa {

/// What was to be written did not fit: the disk is full, or the file may grow no more.
struct DiskFull : InputError {
  using InputError::InputError;
};

/// A file that appears under its final name only when complete: written beside it under a temporary
/// name, NAME.partial- and random digits (of a NAME that would be too long with them its begin and
/// a digest), renamed by Commit(), removed when destroyed without it.
/// What a process that was killed left stays under that name. Throws InputError when the place
/// cannot be written (no such folder, disk full), or a folder or a device has that name: a rename
/// would put a file in a device's place. A symbolic link stays one and what it leads to is written;
/// a file that may not be written to is not replaced, though its folder would allow it; one that
/// is replaced hands its permissions on.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  /// Throws the constructor's InputError; leaves nothing. For what is written after hours of work.
  static void CheckWritable(const std::filesystem::path& final_path);
  /// What was to become this file, of processes that were killed: nobody writes it any more. In
  /// order of their names. On file systems that know no locks nobody can tell, and there are none.
  static std::vector<std::filesystem::path> FindLeftovers(const std::filesystem::path& final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream();
  const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Throws DiskFull when something could not be written: for what is written for hours, so that a
  /// full disk is known before the end.
  void Check();
  /// Flushes and checks: what was written is in the file now, and stays if what follows does not
  /// fit or the process is killed. (A machine that loses its power may lose it yet.)
  void Flush();
  /// Forgets what was written from byte `size` on, and that writing failed: writing goes on there.
  /// Throws InputError when not all before it is in the file; only what was flushed surely is.
  void CutTo(uint64_t size);
  /// Takes `count` bytes out of the file at `begin`: what follows them moves there. Of a head that
  /// came out shorter than the room that was left for it. Flushes and checks; writing goes on at
  /// the end.
  void TakeOut(uint64_t begin, uint64_t count);
  /// Flushes, checks, waits until the disk has it, and renames; the object is finished afterwards.
  void Commit();
  /// The same without waiting for the disk: of one of thousands (images of a data set), whose
  /// folder is whole when another file, written after SyncFiles(), says so.
  void CommitOneOfMany();

 private:
  struct Stream;
  void Rename();

  std::string name_;  // as it was given, for messages
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  int file_ = -1;  // locked: says to others that it has somebody who writes it
  std::unique_ptr<Stream> stream_;
  bool committed_ = false;
};

/// The folder that a file is in, "." where the path names none.
std::filesystem::path FolderOf(const std::filesystem::path& path);

/// Waits until the disk has all files of a folder, those in its sub-folders too. Throws DiskFull.
void SyncFiles(const std::filesystem::path& folder);

}  // namespace ossa
