#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "depth/base/atomic_file.h"

namespace ossa {

/// A text file written line by line: a full disk or a killed process leaves complete lines. It
/// appears under its name at the end, like an AtomicFile.
class LineFile {
 public:
  /// `head`: the beginning of the file. Throws InputError, and DiskFull if the head does not fit.
  explicit LineFile(const std::filesystem::path& path, std::string_view head = {});
  /// Throws DiskFull: earlier lines are kept, `lines` is not written at all.
  void Append(std::string_view lines);
  void Finish();
  /// Instead of Finish(), after DiskFull: completes the file with the lines written so far.
  void FinishWithWhatFits();

 private:
  AtomicFile file_;
  uint64_t end_ = 0;  // end of the complete lines
};

}  // namespace ossa
