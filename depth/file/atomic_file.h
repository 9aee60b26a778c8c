#pragma once
#include <filesystem>
#include <fstream>
#include <string>

namespace ossa {

/// A file that appears under its final name only when complete: written beside it under a temporary
/// name, renamed by Commit(), removed when destroyed without it. Throws InputError when the place
/// cannot be written (no such folder, disk full), or a folder or a device has that name: a rename
/// would put a file in a device's place. A symbolic link stays one and what it leads to is written;
/// a file that may not be written to is not replaced, though its folder would allow it.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  /// Throws the constructor's InputError; writes nothing. For what is written after hours of work.
  static void CheckWritable(const std::filesystem::path& final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  const std::filesystem::path& temporary_path() const { return temporary_path_; }

  /// Throws InputError when something could not be written: for what is written for hours, so that
  /// a full disk is known before the end.
  void Check();
  /// Flushes, checks and renames. The object is finished afterwards.
  void Commit();

 private:
  std::string name_;  // as it was given, for messages
  std::filesystem::path final_path_;
  std::filesystem::path temporary_path_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace ossa
