#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "depth/sensor/frame_source.h"

namespace ossa::depth {

/// Whether a file is a PNG by its name, .PNG as well.
bool IsPngName(const std::filesystem::path& path);

/// A folder of 16-bit PNGs in name order, 30 frames a second. Names that are all digits of one
/// length are frame numbers: a number that is missing counts as a dropped frame, and time passes.
/// A first frame whose header is damaged throws InputError at opening: it tells the size of all.
/// Any other frame that cannot be read, or of another size than the first, does when its turn
/// comes; reading again goes on with the one after it.
std::unique_ptr<FrameSource> OpenFolder(const std::filesystem::path& folder,
                                        const SourceOptions& options);

/// One 16-bit PNG: a recording of a single frame. Camera as of the folder or data set it is in.
std::unique_ptr<FrameSource> OpenStill(const std::filesystem::path& png,
                                       const SourceOptions& options);

/// A data set: manifest.json, depth/ and more (docs/architecture.md, "Data set").
bool IsDataSet(const std::filesystem::path& folder);
std::unique_ptr<FrameSource> OpenDataSet(const std::filesystem::path& folder,
                                         const SourceOptions& options);

/// An .oni recording, played by OpenNI2 in a child process: a file that crashes or hangs the
/// library is an InputError here, at opening or at the frame where it happens.
std::unique_ptr<FrameSource> OpenOniFile(const std::filesystem::path& path,
                                         const SourceOptions& options);

/// A device; an empty URI means the first found.
std::unique_ptr<FrameSource> OpenOpenNiDevice(const std::string& uri, const SourceOptions& options);

}  // namespace ossa::depth
