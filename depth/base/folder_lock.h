#pragma once
#include <filesystem>

namespace ossa {

/// Locks a folder for this process during its lifetime, so that two processes do not work in it at
/// once. The lock of a killed process is released. Creates the folder. Throws InputError if another
/// process holds the lock, or the folder cannot be created. On file systems without locks it does
/// nothing.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_ = -1;
};

}  // namespace ossa
