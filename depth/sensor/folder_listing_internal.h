#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"

namespace ossa::depth {

struct ListedFrame {
  std::filesystem::path path;
  int64_t number = 0;  // of the frame: from its name if all names are frame numbers, else its place
  double time_s = 0.0;
};

/// The depth images of a folder that may hold much else.
struct FolderListing {
  std::vector<ListedFrame> frames;  // in order of time
  ImageSize size;                   // that most of them have
};

/// Frames in natural order, 30 a second; or, in order of time, as depth.txt or their names say (see
/// ReadTimesFromNames). What is no depth image is passed over with a note. Throws InputError when
/// there is none.
FolderListing ListDepthFolder(const std::filesystem::path& folder, const SourceOptions& options);

/// Whether a file is a PNG by its name, .PNG as well, and not one that a Mac left beside another.
bool IsPngName(const std::filesystem::path& path);

}  // namespace ossa::depth
