#pragma once
#include <algorithm>
#include <filesystem>
#include <string>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/sensor/frame_source.h"
#include "recon/files/skeleton_io.h"
#include "tools/commands/process.h"
#include "tools/commands/source_options.h"

namespace ossa::commands {

/// Throws InputError if there is no such file. FILE#truth, BAG#/topic and similar are files,
/// too; devices are described by their driver, pipes by their writer.
inline void RequireExists(const std::string& file) {
  if (IsLive(file)) return;
  const bool is_there =
      std::filesystem::exists(file) || std::filesystem::exists(recon::FindSkeletonFile(file)) ||
      (depth::IsRecording(file) && std::filesystem::exists(file.substr(0, file.rfind('#'))));
  if (!is_there) throw InputError(file + ": no such file or folder");
}

inline bool IsNonEmpty(const std::filesystem::path& path) {
  return !std::filesystem::is_directory(path) || !std::filesystem::is_empty(path);
}

/// Whether a folder holds nothing but folders, one of depth images, and cameras beside them. It is
/// no SOURCE, but holds no skeletons either: the refusal as a SOURCE names the folder inside.
inline bool HoldsFolderOfImages(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) return false;
  bool any = false;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = LowerCase(entry.path().filename().string());
    const bool is_beside = name.starts_with('.') || name.starts_with("camera") ||
                           name.starts_with("intrinsic") || name.starts_with("readme");
    if (!entry.is_directory() && !is_beside) return false;
    any = any || (entry.is_directory() && depth::IsRecording(entry.path()));
  }
  return any;
}

inline void PrintUnreadSurface(const std::string& file, const std::string& surface) {
  if (surface.empty() || HasEnding(file, ".ossaperson") || HasEnding(file, ".ossamesh")) return;
  PrintError("ossa: --surface is read for an .ossaperson or .ossamesh only\n");
}

}  // namespace ossa::commands
