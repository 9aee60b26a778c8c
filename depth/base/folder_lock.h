#pragma once
#include <filesystem>

namespace ossa {

/// Holds a folder for this process as long as it lives, so that two do not work in it at once; a
/// process that was killed holds nothing. Makes the folder. Throws InputError when another process
/// holds it, or it cannot be made. On file systems that know no locks nobody holds anything.
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
