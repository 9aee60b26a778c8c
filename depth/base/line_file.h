#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "depth/base/atomic_file.h"

namespace ossa {

/// A file of lines, written as they come: what a full disk or a killed process leaves of it are
/// whole lines. It appears under its name at the end, as AtomicFile's does.
class LineFile {
 public:
  /// `head`: what it begins with. Throws InputError, and DiskFull when the head does not fit.
  explicit LineFile(const std::filesystem::path& path, std::string_view head = {});
  /// Throws DiskFull: all that was appended before stays, of `lines` nothing.
  void Append(std::string_view lines);
  void Finish();
  /// In place of Finish(), after DiskFull: ends the file after what was appended whole.
  void FinishWithWhatFits();

 private:
  AtomicFile file_;
  uint64_t end_ = 0;  // of what is whole
};

}  // namespace ossa
