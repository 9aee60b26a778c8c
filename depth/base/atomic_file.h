#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "depth/base/error.h"

namespace ossa {

/// What was to be written did not fit: the disk is full, or the file may grow no more.
struct DiskFull : InputError {
  using InputError::InputError;
};

/// A file that appears under its final name only when complete: written beside it under a temporary
/// name, renamed by Commit(), removed when destroyed without it. Throws InputError when the place
/// cannot be written (no such folder, disk full), or a folder or a device has that name: a rename
/// would put a file in a device's place. A symbolic link stays one and what it leads to is written;
/// a file that may not be written to is not replaced, though its folder would allow it.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  /// Throws the constructor's InputError; writes nothing. For what is written after hours of work.
  /// Takes away what processes that were killed left beside the file, whole or not.
  static void CheckWritable(const std::filesystem::path& final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Throws DiskFull when something could not be written: for what is written for hours, so that a
  /// full disk is known before the end.
  void Check();
  /// Forgets what was written from byte `size` on, and that writing failed: writing goes on there.
  /// Throws InputError when not all before it is in the file; only what was flushed surely is.
  void CutTo(uint64_t size);
  /// Flushes, checks and renames. The object is finished afterwards.
  void Commit();

 private:
  std::string name_;  // as it was given, for messages
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  std::ofstream stream_;
  int lock_ = -1;  // says to others that the temporary file has somebody who writes it
  bool committed_ = false;
};

}  // namespace ossa
