#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"

namespace ossa::depth {

struct ListedFrame {
  std::filesystem::path path;
  int64_t number = 0;  // frame number: from its name if all names are numbers, else its index
  double time_s = 0.0;
};

/// The depth images of a folder, which may contain other files.
struct FolderListing {
  std::vector<ListedFrame> frames;  // sorted by time
  ImageSize size;                   // of most frames
};

/// Lists frames in natural order at 30 Hz; or by time, if depth.txt or their names state times (see
/// ReadTimesFromNames). Files that are not depth images are skipped with a note. Throws InputError
/// if there are no frames.
FolderListing ListDepthFolder(const std::filesystem::path& folder, const SourceOptions& options);

/// The frames of a folder of `images` depth images by a depth.txt beside them or, as in TUM's data
/// sets, above their folder, or by a Stray Scanner's odometry.csv; empty without one. A list that
/// names no existing file is another program's, if the folder has images; else throws InputError.
std::vector<ListedFrame> FramesByList(const std::filesystem::path& folder, size_t images,
                                      const SourceOptions& options);

/// Notes the unit, in seconds, of the times in `what` if it was guessed.
void NoteUnit(const std::string& what, double unit_s, const SourceOptions& options);

/// The files of a folder, not its folders, in natural order of their names. Throws InputError if it
/// cannot be read.
std::vector<std::filesystem::path> FilesIn(const std::filesystem::path& folder);

}  // namespace ossa::depth
